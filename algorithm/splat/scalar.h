// The few scalar functions that the splat mathematics needs, for any scalar type.
#pragma once

#include <cmath>
#include <cstdint>
#include <type_traits>

namespace sgs {

// A literal in the scalar type: exact in double, rounded to float first for the narrower types.
template <class T>
constexpr T constant(double value) {
  if constexpr (std::is_same_v<T, double>) {
    return value;
  } else {
    return T(static_cast<float>(value));
  }
}

// The float behind a value, for what is decided and not computed.
inline float value_of(float x) { return x; }
inline int value_of(int x) { return x; }

// Whole numbers in the arithmetic of T: an index, and the form in which sub-tiles are kept.
template <class T>
struct WholeNumbers {
  using Index = int;
  using Short = std::uint16_t;
};
template <class T>
using IndexOf = typename WholeNumbers<T>::Index;

// With these bits cleared, or set.
inline int without_bits(int x, int bits) { return x & ~bits; }
inline int with_bits(int x, int bits) { return x | bits; }

// An index, less than 2^24 from 0, as a number.
template <class T>
T number_of(IndexOf<T> index) {
  return T(static_cast<float>(index));
}

template <class T>
inline T sqrt_of(T x) {
  using std::sqrt;
  return T(sqrt(x));
}

template <class T>
inline T log_of(T x) {
  using std::log;
  return T(log(x));
}

template <class T>
inline T exp_of(T x) {
  using std::exp;
  return T(exp(x));
}

// exp(x) in float for x in [-87, 88] (clamped), within 1.1 units in the last place. Branch-free, so
// that a loop over pixels becomes vector code that gives the same bits on every lane and machine.
// x = n ln2 + r with |r| <= ln2/2; exp(r) = 1 + r + r^2 p(r), p of degree 4 with the least largest
// relative error (Remez exchange, coefficients rounded to float one after the other): 3.3e-9.
template <>
inline float exp_of<float>(float x) {
  constexpr float kPerLn2 = 1.44269504F;
  constexpr float kLn2High = 0.693359375F;  // 9 bits: n * high is exact
  constexpr float kLn2Low = -2.12194440e-4F;
  constexpr float kRoundToInteger = 12582912.0F;  // 1.5 * 2^23: adding it leaves round(x)
  x = x < -87.0F ? -87.0F : x;
  x = x > 88.0F ? 88.0F : x;
  const float shifted = x * kPerLn2 + kRoundToInteger;
  const float n = shifted - kRoundToInteger;
  const float r = (x - n * kLn2High) - n * kLn2Low;
  float p = 0x1.6ac37p-10F;
  p = p * r + 0x1.123da6p-7F;
  p = p * r + 0x1.555858p-5F;
  p = p * r + 0x1.55548cp-3F;
  p = p * r + 0x1.fffffcp-2F;
  p = (p * r) * r + r + 1.0F;
  const auto exponent = __builtin_bit_cast(std::uint32_t, shifted)
                        << 23;  // n in the exponent field
  return p * __builtin_bit_cast(float, exponent + 0x3f800000U);
}

// x times a power of two: an addition to its exponent.
inline float scaled_by(float x, float power_of_two) { return x * power_of_two; }

template <class T>
inline T max_of(T a, T b) {
  return a < b ? b : a;
}

template <class T>
inline T min_of(T a, T b) {
  return b < a ? b : a;
}

template <class T>
inline T clamp_of(T x, T low, T high) {
  return max_of(low, min_of(x, high));
}

// x rounded toward zero and clamped to [0, high]; safe for values outside the range of int.
template <class T>
inline IndexOf<T> truncated_index(T x, int high) {
  if (!(x > T(0))) return 0;  // also NaN
  return x >= T(static_cast<float>(high)) ? IndexOf<T>(high) : static_cast<IndexOf<T>>(x);
}

// In a narrower format, within its range: what no operation before has rounded.
template <class H, class S>
H narrowed(S x) {
  return H(x);
}

}  // namespace sgs
