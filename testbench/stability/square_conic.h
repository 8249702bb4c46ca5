// A form of the falloff's exponent that was tried: the square completed,
// q(d) = A (dx + (B/A) dy)^2 + (C - B^2/A) dy^2, where C - B^2/A is 1/c of the covariance [a b; b
// c].
#pragma once

#include <algorithm>
#include <cmath>

#include "algorithm/splat/blend.h"
#include "algorithm/splat/lane_input.h"
#include "algorithm/splat/projection.h"

namespace sgs {

template <class T>
struct SquareConic {
  T a, lean, rest;  // -log2(e) / 2 in a and rest; B/A
};

// The exponent of 2.
template <class T>
T completed_square(const SquareConic<T>& k, T dx, T dy) {
  const T across = T(dx + k.lean * dy);
  return T(k.a * across * across + k.rest * dy * dy);
}

// By the covariance: nothing cancels.
template <class T>
SquareConic<T> square_conic(const Projected<T>& p) {
  const T factor = constant<T>(-0.5 * kLog2E);
  return {T(p.conic_a * factor), T(-p.cov_b / p.cov_c), T(factor / p.cov_c)};
}

// In the half H, of a conic in the wider S, where C - B^2/A cancels; lengths in units of 1/unit px.
template <class H, class S>
SquareConic<H> square_conic_in_half(S conic_a, S conic_b, S conic_c, float unit) {
  const S factor = constant<S>(-0.5 * kLog2E);
  const S lean = S(conic_b / conic_a), rest = S(S(conic_c - conic_b * lean) * factor);
  const float per_area = 1 / (unit * unit);
  return {H(scaled_by(S(conic_a * factor), per_area)), H(lean), H(scaled_by(rest, per_area))};
}

}  // namespace sgs
