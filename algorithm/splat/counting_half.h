// A half (half_scalar.h) that records every operation it goes through: the templates of blending
// instantiated with it round as HalfScalar does, and are counted. Rounding to 16 bits is part of
// the operation that it follows; an addition to an exponent rounds in the same adder.
#pragma once

#include <cstddef>
#include <cstdint>

#include "algorithm/splat/counting.h"
#include "algorithm/splat/half_scalar.h"
#include "algorithm/splat/lane_input.h"

namespace sgs {

class CountingHalf {
 public:
  CountingHalf() = default;
  explicit CountingHalf(float constant) : half_(rounded_to_half(constant)) {}
  explicit CountingHalf(Counting x) : half_(x) { half_.value = rounded_to_half(x.value); }
  Counting counting() const { return half_; }

  friend CountingHalf operator-(CountingHalf a) { return CountingHalf(-a.half_); }
  friend CountingHalf operator+(CountingHalf a, CountingHalf b) {
    return CountingHalf(a.half_ + b.half_);
  }
  friend CountingHalf operator-(CountingHalf a, CountingHalf b) {
    return CountingHalf(a.half_ - b.half_);
  }
  friend CountingHalf operator*(CountingHalf a, CountingHalf b) {
    return CountingHalf(a.half_ * b.half_);
  }
  friend bool operator<(CountingHalf a, CountingHalf b) { return a.half_ < b.half_; }
  friend bool operator>(CountingHalf a, CountingHalf b) { return a.half_ > b.half_; }
  friend bool operator>=(CountingHalf a, CountingHalf b) { return a.half_ >= b.half_; }

 private:
  Counting half_;
};

inline float value_of(CountingHalf a) { return a.counting().value; }

template <>
inline CountingHalf max_of<CountingHalf>(CountingHalf a, CountingHalf b) {
  return CountingHalf(max_of(a.counting(), b.counting()));
}
template <>
inline CountingHalf min_of<CountingHalf>(CountingHalf a, CountingHalf b) {
  return CountingHalf(min_of(a.counting(), b.counting()));
}

template <>
inline CountingHalf narrowed<CountingHalf, Counting>(Counting x) {
  return CountingHalf(recorded(clamped_to_half(x.value), Operation::kRound, x));
}

template <>
struct Exp2TableOf<CountingHalf> : Exp2TableOf<HalfScalar> {};

inline Exp2Parts<CountingHalf> exp2_parts(CountingHalf t) {
  const Exp2Parts<Counting> parts = exp2_parts(t.counting());
  return {CountingHalf(parts.rest), parts.steps};
}
template <>
inline CountingHalf exp2_coefficient(const Exp2Parts<CountingHalf>& parts, std::size_t column) {
  const auto value = Exp2TableOf<HalfScalar>::kTable.column[column][exp2_row(parts.steps)];
  return CountingHalf(row_entry(parts.rest.counting(), value));
}
inline CountingHalf scaled_by_steps(CountingHalf x, std::int32_t steps) {
  return CountingHalf(scaled_by_steps(x.counting(), steps));
}
template <>
inline CountingHalf exp2_of<CountingHalf>(CountingHalf t) {
  return exp2_by_table(t);
}

}  // namespace sgs
