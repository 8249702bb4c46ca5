// Arithmetic in 16 bits as a unit does it that has no wider registers: every sum, difference and
// product is rounded to the nearest IEEE half (ties to even), too large ones to infinity. A float
// holds each value: its 24 bits are more than twice the 11 of a half and two, so that computing in
// float and rounding once gives the correctly rounded half. Branch-free, so that loops over pixels
// become vector code.
//
// Infinity rather than the largest half: far from a needle's centre the two lengths that make up
// the one across it may be too large and of opposite signs. As infinities they add up to no number,
// which is not blended (alpha_of); as largest halves they add up to 0, and the needle would cover
// the frame.
#pragma once

#include <cstdint>

#include "algorithm/splat/exp2.h"
#include "algorithm/splat/scalar.h"

namespace sgs {

constexpr float kLargestHalf = 65504.0F;
constexpr float kLeastInfinite = 65520.0F;  // halfway to the next power of two

// The half nearest to x; NaN stays NaN. Beside 1.5 2^(e + 13), where 2^e <= |x| < 2^(e + 1),
// neighbours in float lie 2^(e - 10) apart, as halves do beside x: a sum with it is rounded as a
// half. Halves below the least normal one lie as they do there.
inline float rounded_to_half(float x) {
  constexpr std::uint32_t kExponent = 0x7F800000U;
  constexpr auto kLeastNormal = __builtin_bit_cast(std::uint32_t, 0x1p-14F);
  constexpr std::uint32_t kTimesBeside = (13U << 23) + (1U << 22);  // added to the bits of 2^e
  const std::uint32_t exponent = __builtin_bit_cast(std::uint32_t, x) & kExponent;
  const std::uint32_t aligned = exponent > kLeastNormal ? exponent : kLeastNormal;
  const auto beside = __builtin_bit_cast(float, aligned + kTimesBeside);
  const float rounded = (x + beside) - beside;
  // A factor rather than a choice of products, which GCC makes a branch of.
  return rounded * (__builtin_fabsf(x) < kLeastInfinite ? 1.0F : __builtin_inff());
}

// The same, but too large ones become the largest: for what is multiplied by 0 where it is not
// wanted.
inline float clamped_to_half(float x) {
  const float rounded = rounded_to_half(x);
  return __builtin_fabsf(rounded) <= kLargestHalf ? rounded : __builtin_copysignf(kLargestHalf, x);
}

// A half in a float.
class HalfScalar {
 public:
  HalfScalar() = default;
  explicit HalfScalar(float x) : value_(rounded_to_half(x)) {}
  // x is a half already.
  static HalfScalar exactly(float x) {
    HalfScalar out;
    out.value_ = x;
    return out;
  }
  float value() const { return value_; }

  friend HalfScalar operator-(HalfScalar a) { return exactly(-a.value_); }
  friend HalfScalar operator+(HalfScalar a, HalfScalar b) {
    return HalfScalar(a.value_ + b.value_);
  }
  friend HalfScalar operator-(HalfScalar a, HalfScalar b) {
    return HalfScalar(a.value_ - b.value_);
  }
  friend HalfScalar operator*(HalfScalar a, HalfScalar b) {
    return HalfScalar(a.value_ * b.value_);
  }
  friend bool operator<(HalfScalar a, HalfScalar b) { return a.value_ < b.value_; }
  friend bool operator>(HalfScalar a, HalfScalar b) { return a.value_ > b.value_; }
  friend bool operator>=(HalfScalar a, HalfScalar b) { return a.value_ >= b.value_; }

 private:
  float value_;
};

template <>
inline HalfScalar narrowed<HalfScalar, float>(float x) {
  return HalfScalar::exactly(clamped_to_half(x));
}

// In half a line for each step is as good as a parabola.
template <>
struct Exp2TableOf<HalfScalar> {
  static constexpr std::size_t kCoefficients = 2;
  static constexpr const Exp2Table<kCoefficients>& kTable = kExp2Lines;
};
// The rest has the last place of t, or none: a half too.
inline Exp2Parts<HalfScalar> exp2_parts(HalfScalar t) {
  const Exp2Parts<float> parts = exp2_parts(t.value());
  return {HalfScalar::exactly(parts.rest), parts.steps};
}
inline HalfScalar scaled_by_steps(HalfScalar x, std::int32_t steps) {
  return HalfScalar(scaled_by_steps(x.value(), steps));
}
template <>
inline HalfScalar exp2_of<HalfScalar>(HalfScalar t) {
  return exp2_by_table(t);
}

}  // namespace sgs
