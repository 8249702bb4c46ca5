// A scalar that computes what a datapath computes, bit for bit, and beside each value a proven
// bound on its distance from what the formula gives without rounding: running error analysis
// (Higham, Accuracy and Stability of Numerical Algorithms, section 3.3). The templates of
// algorithm/splat and algorithm/tune instantiated with it bound their own rounding. Inputs
// are exact, or off by their rounding to the format.
#pragma once

#include <cmath>
#include <limits>

#include "algorithm/splat/exp2.h"
#include "algorithm/splat/half_scalar.h"
#include "algorithm/splat/scalar.h"

namespace sgs {

// Constants of a number format: unit roundoff, half the distance of its smallest numbers, its
// largest. Also how a result is rounded, and how far off 2^t is, in roundoffs (exp2.h).
struct Single {
  static constexpr double kRoundoff = 0x1p-24, kUnderflow = 0x1p-150, kExp2 = 2.2;
  static constexpr double kLargest = std::numeric_limits<float>::max();
  static float rounded(float x) { return x; }
  static float exp2(float t) { return exp2_of(t); }
};
struct Half {
  static constexpr double kRoundoff = 0x1p-11, kUnderflow = 0x1p-25, kExp2 = 2.2;
  static constexpr double kLargest = kLargestHalf;
  static float rounded(float x) { return rounded_to_half(x); }
  static float exp2(float t) { return exp2_of(HalfScalar::exactly(t)).value(); }
};

template <class Format>
struct Bounded {
  float value;
  double error;

  Bounded() = default;  // trivial, as glm wants it
  explicit Bounded(float given)
      : value(Format::rounded(given)), error(std::abs(static_cast<double>(given) - value)) {}
  Bounded(float value_in, double error_in) : value(value_in), error(error_in) {}
  // In a narrower format.
  template <class Wider>
  explicit Bounded(Bounded<Wider> x) : Bounded(after(x.value, x.error)) {}
  explicit operator double() const { return static_cast<double>(value); }

  // The result of one operation. carried: what the errors of its operands make of it.
  static Bounded after(float result, double carried) {
    const float value = Format::rounded(result);
    const double size = std::abs(static_cast<double>(value));
    // The sums of bounds are rounded too.
    constexpr double kOfBounds = 1 + 0x1p-40;
    const double error = kOfBounds * (carried + Format::kRoundoff * size + Format::kUnderflow);
    // No number: an operand was unbounded.
    const bool is_bounded = size < Format::kLargest && error >= 0;
    return {value, is_bounded ? error : std::numeric_limits<double>::infinity()};
  }

  friend Bounded operator-(Bounded a) { return {-a.value, a.error}; }
  friend Bounded operator+(Bounded a, Bounded b) {
    return after(a.value + b.value, a.error + b.error);
  }
  friend Bounded operator-(Bounded a, Bounded b) {
    return after(a.value - b.value, a.error + b.error);
  }
  friend Bounded operator*(Bounded a, Bounded b) {
    const double size_a = std::abs(static_cast<double>(a.value));
    const double size_b = std::abs(static_cast<double>(b.value));
    return after(a.value * b.value, size_a * b.error + size_b * a.error + a.error * b.error);
  }
  friend Bounded operator/(Bounded a, Bounded b) {
    const double divisor = std::abs(static_cast<double>(b.value)) - b.error;
    const double quotient = std::abs(static_cast<double>(a.value) / b.value);
    return after(a.value / b.value, divisor > 0 ? (a.error + quotient * b.error) / divisor
                                                : std::numeric_limits<double>::infinity());
  }
  friend Bounded sqrt(Bounded a) {
    const double root = std::sqrt(static_cast<double>(a.value));
    const double least = std::sqrt(std::max(0.0, a.value - a.error));
    return after(std::sqrt(a.value),
                 root + least > 0 ? a.error / (root + least) : std::sqrt(a.error));
  }
  friend Bounded ceil(Bounded a) {
    const double low = std::ceil(a.value - a.error), high = std::ceil(a.value + a.error);
    return {std::ceil(a.value), high - low};
  }
  // The library's, within a unit in the last place.
  friend Bounded log(Bounded a) {
    const float value = std::log(a.value);
    const double carried = -std::log1p(-std::min(1.0, a.error / a.value));
    return after(value, carried + Format::kRoundoff * std::abs(static_cast<double>(value)));
  }
  // scalar.h: 1.1 units in the last place, one being at most two roundoffs; clamped at both ends.
  friend Bounded exp(Bounded a) {
    const float value = exp_of(a.value);
    const double carried = value * (std::expm1(a.error) + 1.2 * Format::kRoundoff);
    if (a.value + a.error > 88) return {value, std::numeric_limits<double>::infinity()};
    return after(value, carried + (a.value - a.error < -87 ? static_cast<double>(value) : 0.0));
  }
  friend Bounded exp2(Bounded a) {
    constexpr double kLn2 = 0.69314718055994531;
    const float value = Format::exp2(a.value);
    const double carried = value * (std::expm1(kLn2 * a.error) + Format::kExp2 * Format::kRoundoff);
    const bool clamped = a.value - a.error < static_cast<double>(kLeastExp2Argument);
    return after(value, carried + (clamped ? static_cast<double>(value) : 0.0));
  }
  friend bool operator<(Bounded a, Bounded b) { return a.value < b.value; }
  friend bool operator>(Bounded a, Bounded b) { return a.value > b.value; }
  friend bool operator<=(Bounded a, Bounded b) { return a.value <= b.value; }
  friend bool operator>=(Bounded a, Bounded b) { return a.value >= b.value; }
};

using BoundedFloat = Bounded<Single>;
using BoundedHalf = Bounded<Half>;

inline float value_of(BoundedFloat x) { return x.value; }
inline BoundedFloat scaled_by(BoundedFloat x, float power_of_two) {
  return {x.value * power_of_two, x.error * power_of_two};
}

namespace bounded_detail {

// A real number as a datapath holds it; `real` itself is known to a double's last place.
template <class Format>
Bounded<Format> nearest(double real) {
  const float value = Format::rounded(static_cast<float>(real));
  return {value, std::abs(real - value) + 0x1p-51 * std::abs(real)};
}
// Whichever is taken, the other's error may be the result's.
template <class Format>
Bounded<Format> larger(Bounded<Format> a, Bounded<Format> b) {
  return {std::max(a.value, b.value), std::max(a.error, b.error)};
}

}  // namespace bounded_detail

template <>
inline BoundedFloat constant<BoundedFloat>(double value) {
  return bounded_detail::nearest<Single>(value);
}
template <>
inline BoundedHalf constant<BoundedHalf>(double value) {
  return bounded_detail::nearest<Half>(value);
}
template <>
inline BoundedFloat max_of<BoundedFloat>(BoundedFloat a, BoundedFloat b) {
  return bounded_detail::larger(a, b);
}
template <>
inline BoundedFloat min_of<BoundedFloat>(BoundedFloat a, BoundedFloat b) {
  return -bounded_detail::larger(-a, -b);
}
template <>
inline BoundedHalf max_of<BoundedHalf>(BoundedHalf a, BoundedHalf b) {
  return bounded_detail::larger(a, b);
}
template <>
inline BoundedHalf min_of<BoundedHalf>(BoundedHalf a, BoundedHalf b) {
  return -bounded_detail::larger(-a, -b);
}

}  // namespace sgs
