// A conic with the square completed: A dx^2 + 2 B dx dy + C dy^2 = A (dx + (B/A) dy)^2 +
// (C - B^2/A) dy^2. Far out on a needle the three terms are hundreds and cancel to the few that
// count; these two have one sign.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>
#include <limits>

#include "algorithm/splat/constants.h"
#include "algorithm/splat/rects.h"
#include "algorithm/splat/scalar.h"
#include "algorithm/splat/splat.h"

namespace sgs {

// With log2(e) in it: a (dx + lean dy)^2 + rest dy^2 is the exponent of 2. lean is B/A.
template <class T>
struct SquareConic {
  T a, lean, rest;
};

// Once a splat. A is taken as 2^-26 of C at least, so that there is a quotient where no more of it
// is left: as C is below 1 / 0.3 px^2, that moves alpha by 4 % at most 1,280 px from the centre, of
// splats longer than 4,500 px along x. The least number is for a conic of 0, of splats wider than
// 10^10 px.
template <class T>
inline SquareConic<T> square_conic(T conic_a, T conic_b, T conic_c) {
  constexpr float kLeastBeside = 0x1p-26F;
  const T factor = constant<T>(-0.5 * kLog2E);
  const T a = max_of(max_of(conic_a, scaled_by(conic_c, kLeastBeside)),
                     T(std::numeric_limits<float>::min()));
  const T lean = T(conic_b / a);
  return {T(a * factor), lean, T(T(conic_c - conic_b * lean) * factor)};
}

// The terms that square_conic() was made from.
template <class T>
struct ConicTerms {
  T a, b, c;
};
template <class T>
inline ConicTerms<T> conic_terms(const SquareConic<T>& conic) {
  const T inverse = constant<T>(-2 / kLog2E);
  const T a = T(conic.a * inverse), b = T(a * conic.lean);
  return {a, b, T(conic.rest * inverse + b * conic.lean)};
}

// Powers of two, 2^e, by which lengths along x and along y are multiplied.
struct AxisUnits {
  float x, y;
};

// |factor| of a square along an axis is in [1/4, 1) of 4^e, or as near to it as 4^e and 4^-e are
// normal floats.
inline float axis_unit(float factor) {
  constexpr int kFarthest = 126;
  int exponent = 0;
  std::frexp(factor, &exponent);
  exponent = std::clamp(exponent, -kFarthest, kFarthest);
  return std::ldexp(1.0F, (exponent + (exponent & 1)) / 2);
}

// The units of both axes. With them both factors are near 1, however long the ellipse is, and B/A
// is as for a round one that leans.
template <class T>
inline AxisUnits axis_units(const SquareConic<T>& conic) {
  return {axis_unit(value_of(conic.a)), axis_unit(value_of(conic.rest))};
}

// For lengths in these units: additions to exponents.
template <class T>
inline SquareConic<T> in_units(const SquareConic<T>& conic, const AxisUnits& of) {
  return {scaled_by(conic.a, 1 / (of.x * of.x)), scaled_by(conic.lean, of.x / of.y),
          scaled_by(conic.rest, 1 / (of.y * of.y))};
}
// The way back.
template <class T>
inline SquareConic<T> in_px(const SquareConic<T>& conic, const AxisUnits& of) {
  return in_units(conic, AxisUnits{1 / of.x, 1 / of.y});
}

// log2 of exp(power), as of a Log2Conic (blend.h).
template <class T>
inline T log2_falloff(const SquareConic<T>& conic, T dx, T dy) {
  const T across = T(dx + conic.lean * dy);
  return T(conic.a * across * across + conic.rest * dy * dy);
}

// A splat with the square of its conic completed, as blending in half takes it.
template <class T>
struct SquareSplatOf {
  T x, y;  // px, centre
  SquareConic<T> conic;
  T opacity;
  glm::vec<3, T> rgb;
  FootprintOf<T> footprint;  // sub-tiles that may be blended, in the whole frame
};
using SquareSplat = SquareSplatOf<float>;

template <class T>
SquareSplatOf<T> square_splat(const SplatOf<T>& s) {
  return {s.x, s.y, square_conic(s.conic_a, s.conic_b, s.conic_c), s.opacity, s.rgb, s.footprint};
}

}  // namespace sgs
