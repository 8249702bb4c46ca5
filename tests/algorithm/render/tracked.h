// A scalar that knows how far off a float computation can be: `value` is carried in double, `error`
// bounds |what float arithmetic gives - value| through every operation (running error analysis,
// Higham, Accuracy and Stability of Numerical Algorithms, section 3.3). The templates of
// algorithm/splat instantiated with it bound their own rounding.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "algorithm/splat/scalar.h"

namespace sgs::test {

struct Tracked {
  double value, error;

  Tracked() = default;  // trivial, as glm wants it
  explicit Tracked(float exact) : value(exact), error(0) {}
  Tracked(double value_in, double error_in) : value(value_in), error(error_in) {}

  double low() const { return value - error; }
  double high() const { return value + error; }
};

// A real number held as the float nearest to it.
inline Tracked rounded(double value) {
  return {value, std::abs(value - static_cast<double>(static_cast<float>(value)))};
}

// The result of one float operation: `carried` is what the errors of its operands make of it.
inline Tracked after_rounding(double value, double carried) {
  constexpr double kUnitRoundoff = 0x1p-24, kUnderflow = 0x1p-149;
  constexpr double kLargest = std::numeric_limits<float>::max();
  // Beyond float, or no number: anything may come of it.
  if (!(std::abs(value) + carried <= kLargest)) {
    return {value, std::numeric_limits<double>::infinity()};
  }
  return {value, carried + kUnitRoundoff * (std::abs(value) + carried) + kUnderflow};
}

inline Tracked operator-(Tracked a) { return {-a.value, a.error}; }
inline Tracked operator+(Tracked a, Tracked b) {
  return after_rounding(a.value + b.value, a.error + b.error);
}
inline Tracked operator-(Tracked a, Tracked b) {
  return after_rounding(a.value - b.value, a.error + b.error);
}
inline Tracked operator*(Tracked a, Tracked b) {
  return after_rounding(a.value * b.value, std::abs(a.value) * b.error +
                                               std::abs(b.value) * a.error + a.error * b.error);
}
// b stays away from 0 by more than its error wherever the projection divides, unless it left float.
inline Tracked operator/(Tracked a, Tracked b) {
  const double quotient = a.value / b.value;
  if (!(b.error < std::abs(b.value))) return {quotient, std::numeric_limits<double>::infinity()};
  return after_rounding(quotient,
                        (a.error + std::abs(quotient) * b.error) / (std::abs(b.value) - b.error));
}
inline Tracked sqrt(Tracked a) {
  const double root = std::sqrt(a.value);
  return after_rounding(root, a.error / (root + std::sqrt(std::max(0.0, a.low()))));
}
// The middle of the whole numbers that a rounded argument can give, and half their distance.
inline Tracked ceil(Tracked a) {
  if (!(a.error < std::numeric_limits<double>::infinity())) return a;
  const double low = std::ceil(a.low()), high = std::ceil(a.high());
  return {(low + high) / 2, (high - low) / 2};
}
inline bool operator<(Tracked a, Tracked b) { return a.value < b.value; }

// exp as scalar.h computes it in float, 1.1 units in the last place; one unit is at most 2^-23 of
// the value.
inline Tracked exp(Tracked a) {
  const double value = std::exp(a.value);
  const double carried = value * std::expm1(a.error);
  return {value, carried + 1.1 * 0x1p-23 * (value + carried)};
}

}  // namespace sgs::test

namespace sgs {

template <>
inline test::Tracked constant<test::Tracked>(double value) {
  return test::rounded(value);
}

// Where the order of a and b is not sure, either error may be the result's.
template <>
inline test::Tracked max_of<test::Tracked>(test::Tracked a, test::Tracked b) {
  if (a.high() < b.low()) return b;
  if (b.high() < a.low()) return a;
  return {std::max(a.value, b.value), std::max(a.error, b.error)};
}
template <>
inline test::Tracked min_of<test::Tracked>(test::Tracked a, test::Tracked b) {
  return -max_of(-a, -b);
}

}  // namespace sgs
