// 2^t from a table, as special function units make it (Oberman and Siu, "A High-Performance
// Area-Efficient Multifunction Interpolator", ARITH 2005): t = steps / 64 + rest, the row of
// steps mod 64 holds the coefficients of a polynomial in the rest, and steps / 64 is added to the
// exponent of what it gives.
//
// With h = ln2 / 128, the largest |rest| ln2, the parabola is off by h^3 / 24 = 6.6e-9 of the
// value, the line by h^2 / 4 = 7.3e-6: each a small part of its format's last place. In float the
// result is within 1.1 units in the last place: half of one each from the constant of a row and
// from the last sum. Branch-free, so that a loop over pixels becomes vector code that gives the
// same bits on every lane and machine.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "algorithm/splat/scalar.h"

namespace sgs {

constexpr int kExp2RowBits = 6;
constexpr int kExp2Rows = 1 << kExp2RowBits;
constexpr float kLeastExp2Argument = -125.0F;  // below, the result is not a normal number any more

// Coefficients by column, of rest^0 first; a column of floats fills vector registers.
template <std::size_t kCoefficients>
struct Exp2Table {
  alignas(64) float column[kCoefficients][kExp2Rows];
};

namespace exp2_detail {

constexpr double kLn2 = 0.69314718055994531;
constexpr double kStep = 1.0108892860517005;  // 2^(1/64)
constexpr double kHalfStep = kLn2 / (2 * kExp2Rows);

constexpr float rounded(double x, double unit) {
  return static_cast<float>(static_cast<double>(static_cast<std::int64_t>(x / unit + 0.5)) * unit);
}

// Rows of 23, 23 and 16 bits. The cube of y is replaced by the line nearest to it, 3/4 h^2 y.
constexpr Exp2Table<3> parabolas() {
  Exp2Table<3> table{};
  double value = 1;
  for (int row = 0; row < kExp2Rows; ++row, value *= kStep) {
    table.column[0][row] = rounded(value, 0x1p-23);
    table.column[1][row] = rounded(value * kLn2 * (1 + kHalfStep * kHalfStep / 8), 0x1p-22);
    table.column[2][row] = rounded(value * kLn2 * kLn2 / 2, 0x1p-17);
  }
  return table;
}

// Rows of 10 and 11 bits. The square of y is replaced by half its largest value.
constexpr Exp2Table<2> lines() {
  Exp2Table<2> table{};
  double value = 1;
  for (int row = 0; row < kExp2Rows; ++row, value *= kStep) {
    table.column[0][row] = rounded(value * (1 + kHalfStep * kHalfStep / 4), 0x1p-10);
    table.column[1][row] = rounded(value * kLn2, 0x1p-10);
  }
  return table;
}

}  // namespace exp2_detail

inline constexpr Exp2Table<3> kExp2Parabolas = exp2_detail::parabolas();
inline constexpr Exp2Table<2> kExp2Lines = exp2_detail::lines();

// The table whose entries are numbers of T.
template <class T>
struct Exp2TableOf {
  static constexpr std::size_t kCoefficients = 3;
  static constexpr const Exp2Table<kCoefficients>& kTable = kExp2Parabolas;
};

template <class T>
struct Exp2Parts {
  T rest;              // rest after the last step, at most 1/128 from 0; no number where t is none
  std::int32_t steps;  // steps of 1/64
};

// t >= kLeastExp2Argument. Above 0 the steps, above 1000 also the rest, mean nothing.
inline Exp2Parts<float> exp2_parts(float t) {
  constexpr float kRoundToStep = 0x1.8p17F;  // the last place of a sum with it is 1/64
  const float shifted = t + kRoundToStep;
  return {t - (shifted - kRoundToStep),
          static_cast<std::int32_t>(__builtin_bit_cast(std::uint32_t, shifted) -
                                    __builtin_bit_cast(std::uint32_t, kRoundToStep))};
}

inline std::size_t exp2_row(std::int32_t steps) {
  return static_cast<std::size_t>(steps & (kExp2Rows - 1));
}

template <class T>
inline T exp2_coefficient(const Exp2Parts<T>& parts, std::size_t column) {
  return T(Exp2TableOf<T>::kTable.column[column][exp2_row(parts.steps)]);
}

// x 2^(steps / 64, rounded down): an addition to the exponent.
inline float scaled_by_steps(float x, std::int32_t steps) {
  const auto whole = static_cast<std::uint32_t>(steps >> kExp2RowBits) << 23;
  return __builtin_bit_cast(float, __builtin_bit_cast(std::uint32_t, x) + whole);
}

// The polynomial of a row.
template <class T, std::size_t kCoefficients>
inline T exp2_polynomial(T rest, const std::array<T, kCoefficients>& coefficient) {
  T sum = coefficient[kCoefficients - 1];
  for (std::size_t k = kCoefficients - 1; k-- > 0;) sum = T(sum * rest + coefficient[k]);
  return sum;
}

template <class T>
inline T exp2_by_table(T t) {
  const Exp2Parts<T> parts = exp2_parts(max_of(t, T(kLeastExp2Argument)));
  std::array<T, Exp2TableOf<T>::kCoefficients> coefficient;
  for (std::size_t k = 0; k < coefficient.size(); ++k) coefficient[k] = exp2_coefficient(parts, k);
  return scaled_by_steps(exp2_polynomial(parts.rest, coefficient), parts.steps);
}

// 2^t; t is not above 0 in the arithmetics of a unit.
template <class T>
inline T exp2_of(T t) {
  using std::exp2;
  return T(exp2(t));
}
template <>
inline float exp2_of<float>(float t) {
  return exp2_by_table(t);
}

}  // namespace sgs
