// A conic with the square completed: A dx^2 + 2 B dx dy + C dy^2 = A (dx + (B/A) dy)^2 +
// (C - B^2/A) dy^2. Far out on a needle the three terms are hundreds and cancel to the few that
// count; these two have one sign.
#pragma once

#include <limits>

#include "algorithm/splat/constants.h"
#include "algorithm/splat/scalar.h"

namespace sgs {

// With log2(e) in it: a (dx + lean dy)^2 + rest dy^2 is the exponent of 2. lean is B/A.
template <class T>
struct SquareConic {
  T a, lean, rest;
};

// Once a splat. A is taken as 2^-26 of C at least, so that there is a quotient where rounding (a
// record in half) has left none of it: as C is below 1 / 0.3 px^2, that moves alpha by 4 % at most
// 1,280 px from the centre, of splats longer than 4,500 px along x. The least number is for a conic
// of 0, of splats wider than 10^10 px.
template <class T>
inline SquareConic<T> square_conic(T conic_a, T conic_b, T conic_c) {
  constexpr float kLeastBeside = 0x1p-26F;
  const T factor = constant<T>(-0.5 * kLog2E);
  const T a = max_of(max_of(conic_a, scaled_by(conic_c, kLeastBeside)),
                     T(std::numeric_limits<float>::min()));
  const T lean = T(conic_b / a);
  return {T(a * factor), lean, T(T(conic_c - conic_b * lean) * factor)};
}

// log2 of exp(power), as of a Log2Conic (blend.h).
template <class T>
inline T log2_falloff(const SquareConic<T>& conic, T dx, T dy) {
  const T across = T(dx + conic.lean * dy);
  return T(conic.a * across * across + conic.rest * dy * dy);
}

}  // namespace sgs
