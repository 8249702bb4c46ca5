// Latencies in clock cycles: mean and percentiles from a histogram of bounded size.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sgs {

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

}  // namespace sgs
