// Can a Gaussian, of which only the centre and the largest scale are known, touch the frame? By the
// four planes of the frame's pyramid, moved outwards: without the division and the roots of
// coarse_bound.h, which finds the pixels of any rectangle.
//
// A splat is drawn in the tiles that the square of half-size radius touches, and with lambda of
// coarse_bound.h
//   radius <= 3.00003 (sqrt(lambda - 0.3) + sqrt(0.3 + 0.3163)) + 1,
//   sqrt(lambda - 0.3) <= 1.00001 (f stretch scale_max / v_z) sqrt(1 + limit_x^2 + limit_y^2),
// as u and w are clamped to the limits. The first tile begins at x = 0, so that what lies on its
// far side has
//   fx v_x + (c_x + radius) v_z < 0;
// over fx that is v_x + grow scale_max + left v_z < 0 with numbers of the frame. The last tile may
// end up to 15 px beyond the frame. The numbers are larger than they must be by 1e-4 of grow and
// half a pixel: what is rounded is 1e-6 of the terms, with frames of kMaxFramePx 0.03 px.
#pragma once

#include <algorithm>
#include <cmath>

#include "algorithm/splat/view.h"

namespace sgs {

template <class T>
struct FrameSides {
  T grow;                       // reach in the camera's x and y for each unit of the largest scale
  T left, right, above, below;  // reach for each unit of depth, from the middle axis
};

template <class T>
FrameSides<T> frame_sides(const View<T>& view) {
  const double fx = value_of(view.focal_x), fy = value_of(view.focal_y);
  const double limit_x = value_of(view.limit_x), limit_y = value_of(view.limit_y);
  const double spread = double{value_of(view.stretch)} *
                        std::sqrt(1 + limit_x * limit_x + limit_y * limit_y) * std::max(fx, fy) /
                        std::min(fx, fy);
  constexpr double kExtra = 0.3163;  // sqrt(kMinDiscriminant), rounded up
  const double out_px = 1.0001 * kRadiusSigmas * std::sqrt(kLowPass + kExtra) + 1 + 0.5;
  const auto to_tile = [](int px) { return (px + kTilePx - 1) / kTilePx * kTilePx; };
  const double cx = value_of(view.centre_x), cy = value_of(view.centre_y);
  FrameSides<T> sides{};
  sides.grow = constant<T>(1.0001 * kRadiusSigmas * spread);
  sides.left = constant<T>((cx + out_px) / fx);
  sides.right = constant<T>((to_tile(view.width) - cx + out_px) / fx);
  sides.above = constant<T>((cy + out_px) / fy);
  sides.below = constant<T>((to_tile(view.height) - cy + out_px) / fy);
  return sides;
}

// False: no pixel of the frame can show it.
template <class T>
bool may_touch_frame(const View<T>& view, const FrameSides<T>& sides, const glm::vec<3, T>& mean,
                     T scale_max) {
  const glm::vec<3, T> v = to_camera(view, mean);
  if (!(v.z > constant<T>(kNearPlane))) return false;
  const T reach = T(sides.grow * scale_max);
  const auto beyond = [&](const T& at, const T& before, const T& behind) {
    return T(T(reach + at) + before * v.z) < T(0.0F) || T(T(reach - at) + behind * v.z) < T(0.0F);
  };
  return !beyond(v.x, sides.left, sides.right) && !beyond(v.y, sides.above, sides.below);
}

}  // namespace sgs
