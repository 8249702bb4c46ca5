// A splat as the arithmetic of the blending lanes takes it, beside a sub-tile's first pixel.
#pragma once

#include <cmath>
#include <cstdint>

#include "algorithm/splat/blend.h"
#include "algorithm/splat/scalar.h"
#include "algorithm/splat/splat.h"

namespace sgs {

template <class T>
struct LaneInput {
  Log2Conic<T> conic;
  T opacity, red, green, blue;
  T left, top;     // splat centre minus the sub-tile's first pixel
  float pixel_px;  // distance of neighbours, in the same unit
};

// left, top: px. Blending in the scalar that the splat is given in.
template <class S>
LaneInput<S> lane_input(const SplatOf<S>& s, S left, S top) {
  return {log2_conic(s.conic_a, s.conic_b, s.conic_c),
          s.opacity,
          s.rgb.x,
          s.rgb.y,
          s.rgb.z,
          left,
          top,
          1.0F};
}

// x times a power of two: an addition to its exponent.
inline float scaled_by(float x, float power_of_two) { return x * power_of_two; }

// In a narrower format, within its range: what no operation before has rounded.
template <class H, class S>
H narrowed(S x) {
  return H(x);
}

// In the half H. 4^e in [1/4, 1) of the larger of A and C: lengths are in units of 2^e px.
template <class H, class S>
LaneInput<H> lane_input_in_half(const SplatOf<S>& s, S left, S top) {
  int exponent = 0;
  std::frexp(value_of(max_of(s.conic_a, s.conic_c)), &exponent);
  const int e = (exponent + (exponent & 1)) / 2;
  const float unit = std::ldexp(1.0F, e), per_area = std::ldexp(1.0F, -2 * e);
  const Log2Conic<S> conic = log2_conic(s.conic_a, s.conic_b, s.conic_c);
  return {{H(scaled_by(conic.a, per_area)), H(scaled_by(conic.b, per_area)),
           H(scaled_by(conic.c, per_area))},
          narrowed<H>(s.opacity),
          narrowed<H>(s.rgb.x),
          narrowed<H>(s.rgb.y),
          narrowed<H>(s.rgb.z),
          H(scaled_by(left, unit)),
          H(scaled_by(top, unit)),
          unit};
}

}  // namespace sgs
