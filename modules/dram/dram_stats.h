// Statistics of the memory up to a moment. Counts are integers; rates are derived when asked for.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "modules/dram/command.h"
#include "modules/dram/dram_energy.h"
#include "modules/dram/latency_histogram.h"
#include "modules/dram/row_counts.h"
#include "tlm/traffic_counters.h"

namespace sgs {

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

  std::vector<RankActivity> ranks;                         // channel * ranks + rank
  DramEnergy energy;                                       // by the configured set of currents
  std::map<std::string, double> energy_by_current_set_pj;  // the band between published sets

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
