// A splat as the arithmetic of the blending lanes takes it, beside a sub-tile's first pixel.
#pragma once

#include "algorithm/splat/blend.h"
#include "algorithm/splat/scalar.h"
#include "algorithm/splat/splat.h"
#include "algorithm/splat/square_conic.h"
#include "algorithm/splat/square_splat.h"

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

// In the half H. Lengths along x are in units of their own, and so are those along y.
template <class H, class S>
LaneInput<H, SquareConic<H>> lane_input_in_half(const SquareSplatOf<S>& s, S left, S top) {
  const AxisUnits units = axis_units(s.conic);
  const SquareConic<S> conic = in_units(s.conic, units);
  return {{H(conic.a), H(conic.lean), H(conic.rest)},
          narrowed<H>(s.opacity),
          narrowed<H>(s.rgb.x),
          narrowed<H>(s.rgb.y),
          narrowed<H>(s.rgb.z),
          H(scaled_by(left, units.x)),
          H(scaled_by(top, units.y)),
          units.x,
          units.y};
}

}  // namespace sgs
