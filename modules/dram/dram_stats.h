// Statistics of the memory up to a moment. Counts are integers; rates are derived when asked for.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "modules/dram/command.h"
#include "modules/dram/dram_energy.h"
#include "modules/dram/row_counts.h"
#include "tlm/traffic_counters.h"

namespace sgs {

// Latencies in clock cycles: mean and percentiles from a histogram of bounded size.

// Exact below 1024 cycles; above, bins of 1/512 of their octave, so a percentile is low by at most
// 0.2 %.
class LatencyHistogram {
 public:
  void add(std::uint64_t cycles) {
    ++bins_[bin_of(cycles)];
    ++count_;
    sum_ += cycles;
    if (cycles > max_) max_ = cycles;
  }

  std::uint64_t count() const { return count_; }
  std::uint64_t max() const { return max_; }
  double mean() const {
    return count_ == 0 ? 0.0 : static_cast<double>(sum_) / static_cast<double>(count_);
  }

  // Smallest latency (its bin's lower edge) that at least `fraction` of all do not exceed.
  std::uint64_t percentile(double fraction) const {
    const double wanted = fraction * static_cast<double>(count_);
    std::uint64_t seen = 0;
    for (std::size_t bin = 0; bin < kBins; ++bin) {
      seen += bins_[bin];
      if (seen > 0 && static_cast<double>(seen) >= wanted) return lower_edge(bin);
    }
    return max_;
  }

  LatencyHistogram& operator+=(const LatencyHistogram& other) {
    for (std::size_t bin = 0; bin < kBins; ++bin) bins_[bin] += other.bins_[bin];
    count_ += other.count_;
    sum_ += other.sum_;
    if (other.max_ > max_) max_ = other.max_;
    return *this;
  }

 private:
  static constexpr std::uint32_t kLinearBits = 10;
  static constexpr std::uint32_t kLinear = 1u << kLinearBits;
  static constexpr std::uint32_t kPerOctave = kLinear / 2;
  static constexpr std::size_t kBins = kLinear + std::size_t{kPerOctave} * (40 - kLinearBits);

  static std::size_t bin_of(std::uint64_t cycles) {
    if (cycles < kLinear) return cycles;
    std::uint32_t octave = 0;
    while ((cycles >> octave) >= kLinear) ++octave;
    const std::size_t bin =
        kLinear + std::size_t{octave - 1} * kPerOctave + ((cycles >> octave) - kPerOctave);
    return bin < kBins ? bin : kBins - 1;
  }
  static std::uint64_t lower_edge(std::size_t bin) {
    if (bin < kLinear) return bin;
    const std::size_t octave = (bin - kLinear) / kPerOctave + 1;
    return (std::uint64_t{kPerOctave} + (bin - kLinear) % kPerOctave) << octave;
  }

  // On the heap: statistics are passed around on the small stacks of SystemC threads.
  std::vector<std::uint64_t> bins_ = std::vector<std::uint64_t>(kBins);
  std::uint64_t count_ = 0;
  std::uint64_t sum_ = 0;
  std::uint64_t max_ = 0;
};

struct DramChannelStats {
  RowCounts rows;                                   // bursts by outcome
  std::array<std::uint64_t, kCommands> commands{};  // by Command
  std::uint64_t busy_cycles = 0;                    // busy cycles of the data bus

  std::uint64_t count(Command c) const { return commands[static_cast<std::size_t>(c)]; }
  std::uint64_t activates() const { return count(Command::kActivate); }
  std::uint64_t refreshes() const {
    return count(Command::kRefreshAll) + count(Command::kRefreshBank);
  }
  std::uint64_t bursts() const {
    return count(Command::kRead) + count(Command::kReadAuto) + count(Command::kWrite) +
           count(Command::kWriteAuto);
  }
};

struct DramStats {
  double clock_period_ns = 0;
  double peak_gb_per_s = 0;  // peak of all channels together
  std::uint32_t burst_bytes = 0;
  std::uint32_t burst_cycles = 0;
  std::uint64_t elapsed_cycles = 0;
  std::uint64_t busy_cycles = 0;  // in which at least one request was in the controller

  TrafficCounters traffic;  // as asked for: transactions and their bytes
  // Bursts on the bus by region and direction; a partial burst costs a whole one.
  std::array<std::array<std::uint64_t, 2>, 256> bursts_by_region{};
  std::vector<DramChannelStats> channels;
  LatencyHistogram read_latency_cycles;   // arrival to last datum, of a transaction
  LatencyHistogram write_latency_cycles;  // arrival to last datum, also of posted writes
  std::uint64_t forwarded_reads = 0;      // answered from the write queue

  std::vector<RankActivity> ranks;  // channel * ranks + rank
  DramEnergyBand energy;

  DramChannelStats all_channels() const;
  std::uint64_t bytes() const { return traffic.total().bytes; }
  std::uint64_t bus_bytes() const { return all_channels().bursts() * burst_bytes; }
  double elapsed_ns() const { return static_cast<double>(elapsed_cycles) * clock_period_ns; }

  // Bytes asked for over all the time, and over the time in which requests were there; GB/s.
  double bandwidth_gb_per_s() const;
  double busy_bandwidth_gb_per_s() const;
  // Share of bursts that found their row open.
  double row_hit_rate() const;
};

}  // namespace sgs
