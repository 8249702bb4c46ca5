// A dual number: a value and its derivative along one direction, carried exactly through every
// operation. The templates of algorithm/splat instantiated with it differentiate themselves.
#pragma once

#include <cmath>

#include "algorithm/splat/scalar.h"

namespace sgs::test {

struct Dual {
  double value, slope;

  Dual() = default;  // trivial, as glm wants it
  explicit Dual(double constant) : value(constant), slope(0) {}
  Dual(double value_in, double slope_in) : value(value_in), slope(slope_in) {}
  explicit operator int() const { return static_cast<int>(value); }
  explicit operator double() const { return value; }

  Dual& operator+=(Dual b) {
    value += b.value;
    slope += b.slope;
    return *this;
  }
};

inline Dual operator-(Dual a) { return {-a.value, -a.slope}; }
inline Dual operator+(Dual a, Dual b) { return {a.value + b.value, a.slope + b.slope}; }
inline Dual operator-(Dual a, Dual b) { return {a.value - b.value, a.slope - b.slope}; }
inline Dual operator*(Dual a, Dual b) {
  return {a.value * b.value, a.slope * b.value + a.value * b.slope};
}
inline Dual operator/(Dual a, Dual b) {
  const double quotient = a.value / b.value;
  return {quotient, (a.slope - quotient * b.slope) / b.value};
}
inline bool operator<(Dual a, Dual b) { return a.value < b.value; }
inline bool operator>(Dual a, Dual b) { return a.value > b.value; }
inline bool operator<=(Dual a, Dual b) { return a.value <= b.value; }
inline bool operator>=(Dual a, Dual b) { return a.value >= b.value; }

inline Dual sqrt(Dual a) {
  const double root = std::sqrt(a.value);
  return {root, a.slope / (2 * root)};
}
inline Dual exp(Dual a) {
  const double value = std::exp(a.value);
  return {value, value * a.slope};
}
inline Dual exp2(Dual a) {
  const double value = std::exp2(a.value);
  return {value, value * std::log(2.0) * a.slope};
}
inline Dual log(Dual a) { return {std::log(a.value), a.slope / a.value}; }
inline Dual abs(Dual a) { return a.value < 0 ? -a : a; }
inline Dual ceil(Dual a) { return Dual(std::ceil(a.value)); }
inline Dual floor(Dual a) { return Dual(std::floor(a.value)); }
inline bool isfinite(Dual a) { return std::isfinite(a.value); }

}  // namespace sgs::test

namespace sgs {

template <>
inline test::Dual constant<test::Dual>(double value) {
  return test::Dual(value);
}

}  // namespace sgs
