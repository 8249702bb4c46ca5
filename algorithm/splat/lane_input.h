// A splat as the arithmetic of the blending lanes takes it, beside a sub-tile's first pixel.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "algorithm/splat/blend.h"
#include "algorithm/splat/scalar.h"
#include "algorithm/splat/splat.h"
#include "algorithm/splat/square_conic.h"

namespace sgs {

// Conic: Log2Conic<T>, or SquareConic<T>.
template <class T, class Conic>
struct LaneInput {
  Conic conic;
  T opacity, red, green, blue;
  T left, top;             // splat centre minus the sub-tile's first pixel
  float pixel_x, pixel_y;  // distance of neighbours, in the same units
};

// left, top: px. Blending in the scalar that the splat is given in.
template <class S>
LaneInput<S, Log2Conic<S>> lane_input(const SplatOf<S>& s, S left, S top) {
  return {log2_conic(s.conic_a, s.conic_b, s.conic_c),
          s.opacity,
          s.rgb.x,
          s.rgb.y,
          s.rgb.z,
          left,
          top,
          1.0F,
          1.0F};
}

// In a narrower format, within its range: what no operation before has rounded.
template <class H, class S>
H narrowed(S x) {
  return H(x);
}

// The power of two, 2^e, by which lengths along an axis are multiplied: |factor| of their square is
// in [1/4, 1) of 4^e, or as near to it as 4^e and 4^-e are normal floats.
inline float unit_of(float factor) {
  constexpr int kFarthest = 126;
  int exponent = 0;
  std::frexp(factor, &exponent);
  exponent = std::clamp(exponent, -kFarthest, kFarthest);
  return std::ldexp(1.0F, (exponent + (exponent & 1)) / 2);
}

// In the half H. Lengths along x are in units of their own, and so are those along y: both factors
// are near 1, however long the ellipse is, and B/A is what it is for a round one that leans.
template <class H, class S>
LaneInput<H, SquareConic<H>> lane_input_in_half(const SplatOf<S>& s, S left, S top) {
  const SquareConic<S> conic = square_conic(s.conic_a, s.conic_b, s.conic_c);
  const float unit_x = unit_of(value_of(conic.a)), unit_y = unit_of(value_of(conic.rest));
  return {{H(scaled_by(conic.a, 1 / (unit_x * unit_x))), H(scaled_by(conic.lean, unit_x / unit_y)),
           H(scaled_by(conic.rest, 1 / (unit_y * unit_y)))},
          narrowed<H>(s.opacity),
          narrowed<H>(s.rgb.x),
          narrowed<H>(s.rgb.y),
          narrowed<H>(s.rgb.z),
          H(scaled_by(left, unit_x)),
          H(scaled_by(top, unit_y)),
          unit_x,
          unit_y};
}

}  // namespace sgs
