// A splat with the square of its conic completed, as blending in half takes it.
#pragma once

#include <glm/vec3.hpp>

#include "algorithm/splat/rects.h"
#include "algorithm/splat/splat.h"
#include "algorithm/splat/square_conic.h"

namespace sgs {

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
