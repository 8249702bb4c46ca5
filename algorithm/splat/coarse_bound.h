// The coarse filter: can a Gaussian, of which only the centre and the largest scale are known,
// touch a rectangle of pixels?
//
// With J the Jacobian at the clamped centre, |J|^2 <= (f/v_z)^2 (1 + u^2 + w^2), f = max(fx, fy),
// and |R^T| <= stretch, so the largest eigenvalue of the 2D covariance is at most
//   lambda = (f stretch scale_max / v_z)^2 (1 + u^2 + w^2) + 0.3.
// A splat is visible within kVisibleSigmas sqrt(lambda) of its centre (opacity at most 1), widened
// as in footprint.h with kappa <= (2 lambda)^2 / (0.3 lambda), since det >= 0.3 lambda. It is also
// cut to the tiles that the square of half-size `radius` touches: at most 16 px beyond that. The
// lambda of the radius is mid + sqrt(max(0.1, mid^2 - det)) <= lambda + sqrt(0.1).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "algorithm/splat/footprint.h"
#include "algorithm/splat/view.h"

namespace sgs {

// The size of a Gaussian that a coarse filter knows beside its centre.
enum class CoarseBoundBy : std::uint8_t {
  kLargestScale,  // coarse_bound(): the paper's
  kExtents,       // extent_bound.h
};

template <class T>
struct CoarseBoundOf {
  bool in_front;  // v_z > near plane
  T depth;        // v_z
  T x, y;         // px
  T reach_px;     // nothing is blended farther from the centre (Euclidean)
  T square_px;    // nor farther along either axis
};
using CoarseBound = CoarseBoundOf<float>;

template <class T>
CoarseBoundOf<T> coarse_bound(const View<T>& view, const glm::vec<3, T>& mean, T scale_max) {
  CoarseBoundOf<T> out{};
  const glm::vec<3, T> v = to_camera(view, mean);
  out.depth = v.z;
  out.in_front = v.z > constant<T>(kNearPlane);
  if (!out.in_front) return out;
  const auto pixel = to_pixel(view, v);
  out.x = pixel.x;
  out.y = pixel.y;
  const auto [u, w] = clamped_ratio(view, v);
  const T spread = T(max_of(view.focal_x, view.focal_y) * view.stretch * T(scale_max / v.z));
  // 1e-5: the covariance of projection.h is a sum of squares, exact to a few units in the last
  // place.
  const T lambda =
      T(T(spread * spread * T(T(1.0F) + u * u + w * w) + constant<T>(kLowPass)) * T(1.00001F));
  const T sigma = sqrt_of(lambda);
  const T widening = ellipse_widening(T(T(4.0F) / constant<T>(kLowPass) * lambda));
  const T slack_px = T(0.05F);
  out.reach_px = widening < T(kMaxWidening)
                     ? T(constant<T>(kVisibleSigmas) * sigma * T(T(1.0002F) + widening) + slack_px)
                     : T(std::numeric_limits<float>::max());
  const T radius_extra = T(0.3163F);  // sqrt(kMinDiscriminant), rounded up
  out.square_px = T(constant<T>(kRadiusSigmas) * sqrt_of(T(lambda + radius_extra)) * T(1.00001F) +
                    T(1.0F) + constant<T>(kTilePx));
  return out;
}

// True if the bound touches a rectangle of pixels.
template <class T>
bool touches(const CoarseBoundOf<T>& bound, const PixelRect& pixels) {
  const auto outside = [](T at, int low, int high) {
    const T before = T(T(static_cast<float>(low)) - at);
    const T behind = T(at - T(static_cast<float>(high - 1)));
    return max_of(max_of(before, behind), T(0.0F));
  };
  const T dx = outside(bound.x, pixels.x0, pixels.x1);
  const T dy = outside(bound.y, pixels.y0, pixels.y1);
  return max_of(dx, dy) <= bound.square_px &&
         T(dx * dx + dy * dy) <= T(bound.reach_px * bound.reach_px);
}

// Can a Gaussian, of which only the centre and the largest scale are known, touch the frame? By the
// four planes of the frame's pyramid, moved outwards: without the division and the roots of
// coarse_bound(), which finds the pixels of any rectangle.
//
// A splat is drawn in the tiles that the square of half-size radius touches, and with lambda of
// coarse_bound()
//   radius <= 3.00003 (sqrt(lambda - 0.3) + sqrt(0.3 + 0.3163)) + 1,
//   sqrt(lambda - 0.3) <= 1.00001 (f stretch scale_max / v_z) sqrt(1 + limit_x^2 + limit_y^2),
// as u and w are clamped to the limits. The first tile begins at x = 0, so that what lies on its
// far side has
//   fx v_x + (c_x + radius) v_z < 0;
// over fx that is v_x + grow scale_max + left v_z < 0 with numbers of the frame. The last tile may
// end up to 15 px beyond the frame. The numbers are larger than they must be by 1e-4 of grow and
// half a pixel: what is rounded is 1e-6 of the terms, with frames of kMaxFramePx 0.03 px.
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

// False: no pixel of the frame can show it, nor of the other eye's.
template <class T>
bool may_touch_frame(const View<T>& view, const FrameSides<T>& sides, const glm::vec<3, T>& mean,
                     T scale_max) {
  const glm::vec<3, T> v = to_camera(view, mean);
  if (!(v.z > constant<T>(kNearPlane))) return false;
  const T reach = T(sides.grow * scale_max);
  // at, last: as seen by the first and by the last of the view's eyes.
  const auto beyond = [&](const T& at, const T& last, const T& before, const T& behind) {
    return T(T(reach + at) + before * v.z) < T(0.0F) || T(T(reach - last) + behind * v.z) < T(0.0F);
  };
  const T last_x = view.eyes > 1 ? T(v.x - view.eyes_apart) : v.x;
  return !beyond(v.x, last_x, sides.left, sides.right) &&
         !beyond(v.y, v.y, sides.above, sides.below);
}

}  // namespace sgs
