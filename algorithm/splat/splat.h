// One Gaussian on the screen, with its colour: the fine filter hands it on and rendering blends it.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "algorithm/splat/rects.h"

namespace sgs {

template <class T>
struct SplatOf {
  T x, y;                       // px, centre
  T conic_a, conic_b, conic_c;  // 1/px^2
  T opacity;
  T depth;              // v_z, the sorting key
  std::uint32_t index;  // in the cloud: orders equal depths
  glm::vec<3, T> rgb;
  FootprintOf<T> footprint;  // sub-tiles that may be blended, in the whole frame
};
using Splat = SplatOf<float>;

// Front to back; equal depths by index.
inline bool in_front(const Splat& a, const Splat& b) {
  return a.depth < b.depth || (a.depth == b.depth && a.index < b.index);
}

}  // namespace sgs
