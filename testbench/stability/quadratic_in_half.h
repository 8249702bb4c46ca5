// A form of blending in half that was tried: the three terms as in float, whose far needles are
// noise.
#pragma once

#include <cmath>

#include "algorithm/splat/blend.h"

namespace sgs {

// 4^e in [1/4, 1) of the larger of A and C: lengths are in units of 2^e px.
template <class H, class S>
BlendInput<H, Log2Conic<H>> quadratic_lanes_in_half(const SplatOf<S>& s, S left, S top) {
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
          unit,
          unit};
}

}  // namespace sgs
