// Many sums to which any thread may add, and which come out the same to the bit whatever the number
// of threads and the order in which they come.
#pragma once

#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace sgs {

// Why the order does not matter: each addend is rounded by itself, toward zero, to a multiple of
// the resolution 2^-fraction_bits; what follows is addition of whole numbers of 128 bits, which
// rounds nothing. (Sums of floating-point numbers round at every step, each order in its own way.)
// Resolution: an addend loses less than 2^-fraction_bits; smaller ones are lost whole. 2^-32 for
// shares of the light of pixels; the caller knows how small its addends are.
// Range: addends of magnitude below 2^(63 - fraction_bits), 2^31 by default. No sum of fewer than
// 2^61 of them overflows. Any other addend, infinite or not a number, makes its sum NaN for good,
// whatever comes before or behind: a sum is never silently wrong.
class FixedPointSums {
 public:
  // count sums of 0. fraction_bits: 0 to 62.
  explicit FixedPointSums(std::size_t count, int fraction_bits = 32)
      : sums_(count),
        units_per_one_(std::ldexp(1.0, fraction_bits)),
        resolution_(std::ldexp(1.0, -fraction_bits)) {}

  std::size_t size() const { return sums_.size(); }

  // From any thread.
  void add(std::size_t index, double value) {
    Sum& sum = sums_[index];
    const double units = value * units_per_one_;  // a power of two: exact
    if (!(std::abs(units) < 0x1p63)) {
      sum.high.store(kNotANumber, std::memory_order_relaxed);
      return;
    }
    const auto whole = static_cast<std::int64_t>(units);
    const auto low = static_cast<std::uint64_t>(whole);
    const std::uint64_t before = sum.low.fetch_add(low, std::memory_order_relaxed);
    const int carry = before + low < low ? 1 : 0, sign = whole < 0 ? -1 : 0;
    if (carry + sign != 0) sum.high.fetch_add(carry + sign, std::memory_order_relaxed);
  }

  // The double nearest to the sum. When all threads have added.
  double operator[](std::size_t index) const {
    const std::int64_t high = sums_[index].high.load();
    if (high >= kNotANumber / 2) return std::numeric_limits<double>::quiet_NaN();
    const auto bits = static_cast<Bits>(high) << 64 | sums_[index].low.load();
    return static_cast<double>(static_cast<Whole>(bits)) * resolution_;
  }

 private:
  __extension__ using Whole = __int128;
  __extension__ using Bits = unsigned __int128;

  // high 2^64 + low. A high part near kNotANumber marks a sum that is NaN: carries never reach it,
  // nor lead back from it.
  static constexpr std::int64_t kNotANumber = std::int64_t{1} << 62;
  struct Sum {
    std::atomic<std::uint64_t> low{0};
    std::atomic<std::int64_t> high{0};
  };
  std::vector<Sum> sums_;
  double units_per_one_, resolution_;
};

}  // namespace sgs
