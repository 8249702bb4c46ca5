// Can any Gaussian of a chunk change a pixel of a group, and how near can the nearest one be?
//
// A splat is blended no farther from its centre x than half_x <= F k sqrt(cov_a) + 0.02 px along x
// (footprint.h), where F covers the widening for rounding, cov_a = |u1|^2 + 0.3 and
// u1 = (fx / v_z) M^T n with n = axis_x - u axis_z, axes the rows of R^T and u = clamp(v_x / v_z).
// With E the largest visible half-extents k sqrt(Sigma_aa) along the world's axes,
// k |M^T n| <= sum_a |n_a| E_a, and sqrt(A + B) <= sqrt(A) + sqrt(B). So x + half_x >= x0, times
// v_z:
//   fx v_x + (cx - x0 + c) v_z + F fx sum_a |n_a| E_a >= 0,   c = F k_max sqrt(0.3) + 0.02,
// whose first part is linear in the centre: its maximum over the box of centres is at a corner. The
// other three sides are alike.
// F: with lambda <= (f S stretch / v_z)^2 (1 + u^2 + w^2) + 0.3 and S the largest scale, the
// condition of the 2D covariance is at most 13.4 lambda (coarse_bound.h); while the widening is
// below its limit F = sqrt(1 + widening). Beyond, the footprint is only cut to tiles: half_x <=
// ceil(3 sqrt(lambda + sqrt(0.1))) + 16, which has the same form with 3 f S stretch sqrt(1 + u^2 +
// w^2) in place of the sum. Rounding: a Gaussian's v is off by at most 5 eps sum_a |axis_a| |p_a -
// c_a|, its pixel position by that times fx / v_z and 4 eps |x|; the test itself loses as much
// again. 64 eps (fx + |cx - x0| + c) sum_a |p_a - c_a|, taken at the far corner of the box, covers
// both. It is needed where fx eps reaches a pixel: exact_renderer_test.cpp has frames that lose
// pixels without it.
//
// Which sub-tiles of the group: x lies in cx + fx [least, greatest v_x / v_z over the box], half_x
// within F fx / v_z sum_a |n_a| E_a + c at the nearest v_z. The ranges of v hold what is computed
// (16 eps sum_a |p_a - c_a|, of which 5 are a Gaussian's), the ratios' 1e-5 the quotient and fx's
// product, F's 1.0002 the reach, and of the 0.05 px in c 0.03 are left for cx below 2^15.
// Two eyes (view.h): v_x of the right one is smaller by their distance. Of a left eye the range of
// v_x reaches so far lower, and the right side of the group is tested with the right eye: what
// passes neither test is seen by neither, and sub-tiles are those of both. The subtraction rounds
// by less than eps of the sum that the ranges are widened by, which holds the distance too.
#pragma once

#include <cmath>
#include <limits>

#include "algorithm/splat/extent_bound.h"
#include "algorithm/splat/footprint.h"
#include "algorithm/splat/group_numbers.h"
#include "algorithm/splat/view.h"
#include "algorithm/voxel/chunk_tree.h"

namespace sgs {

template <class T>
struct ChunkTestOf {
  bool touches;      // false: no Gaussian of the chunk changes a pixel of the group
  T nearest;         // no Gaussian of the chunk that is in front has a smaller computed v_z
  GroupReach reach;  // where it touches: no Gaussian changes any other sub-tile of the group
};
using ChunkTest = ChunkTestOf<float>;

template <class T>
class GroupFrustumOf {
 public:
  GroupFrustumOf(const View<T>& view, const PixelRect& pixels)
      : view_(view),
        pixels_(pixels),
        outer_(outer_pixels<T>({pixels.x0, pixels.y0, pixels.x1, pixels.y1})),
        from_middle_(from_middle(outer_, view.centre_x, view.centre_y)) {}

  ChunkTestOf<T> test(const ChunkBoundOf<T>& bound) const;
  // The same, for a walk that asks for no depth and no sub-tiles.
  bool touches(const ChunkBoundOf<T>& bound) const { return compared(bound).touches; }

 private:
  using Vec = glm::vec<3, T>;
  struct Interval {
    T low, high;
  };
  // Where touches: ranges of v_x / v_z and v_y / v_z, and reaches to each side.
  struct Compared {
    bool touches;
    Interval z, x_ratio, y_ratio;
    T reach_x, reach_y, padding_px;
  };
  Compared compared(const ChunkBoundOf<T>& bound) const;

  static Interval ratio_range(Interval x, Interval z);
  static Interval clamped(Interval ratio, T limit);
  static T reach_along(const Vec& axis, const Vec& axis_z, Interval range, const Vec& extent);
  // One side of the group: a point passes when direction . v >= 0 in the camera frame.
  // from_middle_px: from the view's middle to the side, outward.
  // eyes: what the eye that sees this side best adds to the sum, by its place beside the centre.
  bool beyond_side(const Vec& centre, const Vec& half, int axis, T sign, T from_middle_px,
                   T padding_px, T reach, T rounding, T eyes) const;

  const View<T>& view_;
  PixelRect pixels_;
  GroupSides<T> outer_, from_middle_;
};
using GroupFrustum = GroupFrustumOf<float>;

// Sum over the world's axes of |n_a| E_a, at its largest for n = axis - t axis_z with t in the
// range: |n_a| is convex in t, so one of the ends.
template <class T>
T GroupFrustumOf<T>::reach_along(const Vec& axis, const Vec& axis_z, Interval range,
                                 const Vec& extent) {
  using std::abs;
  T sum = T(0.0F);
  for (int a = 0; a < 3; ++a) {
    const T n = max_of(T(abs(T(axis[a] - range.low * axis_z[a]))),
                       T(abs(T(axis[a] - range.high * axis_z[a]))));
    // An infinite extent along an axis that does not matter.
    sum = sum + (n > T(0.0F) ? n * extent[a] : T(0.0F));
  }
  return sum;
}

// Range of v_x / v_z over a box with v_z in [near, far], near > 0.
template <class T>
typename GroupFrustumOf<T>::Interval GroupFrustumOf<T>::ratio_range(Interval x, Interval z) {
  using std::abs;
  const T low = x.low >= T(0.0F) ? x.low / z.high : x.low / z.low;
  const T high = x.high >= T(0.0F) ? x.high / z.low : x.high / z.high;
  const T rounding = T(1e-5F), one = T(1.0F);
  return {T(low - rounding * (one + T(abs(low)))), T(high + rounding * (one + T(abs(high))))};
}

template <class T>
typename GroupFrustumOf<T>::Interval GroupFrustumOf<T>::clamped(Interval ratio, T limit) {
  return {max_of(T(-limit), ratio.low), min_of(limit, ratio.high)};
}

template <class T>
bool GroupFrustumOf<T>::beyond_side(const Vec& centre, const Vec& half, int axis, T sign,
                                    T from_middle_px, T padding_px, T reach, T rounding,
                                    T eyes) const {
  using std::abs;
  using std::isfinite;
  const T focal = axis == 0 ? view_.focal_x : view_.focal_y;
  const T slope = from_middle_px + padding_px;
  T most = eyes;
  for (int a = 0; a < 3; ++a) {
    const T n = sign * focal * view_.cam_from_world[axis][a] + slope * view_.cam_from_world[2][a];
    most = most + (n * centre[a] + T(abs(n)) * half[a]);
  }
  const T slack = T(64 * kRoundoff) * (focal + T(abs(slope))) * rounding;
  const T margin = most + focal * reach + slack;
  return margin < T(0.0F) && isfinite(margin);  // a sum that overflowed says nothing
}

template <class T>
typename GroupFrustumOf<T>::Compared GroupFrustumOf<T>::compared(
    const ChunkBoundOf<T>& bound) const {
  using std::abs;
  const T one = T(1.0F);
  // Box of the centres relative to the camera: middle and half-size, the latter rounded up.
  Vec centre, half;
  T far_sum = T(0.0F);  // largest sum_a |p_a - c_a|
  // from_eye is monotonic in each coordinate: the corners bound what it gives for every centre.
  const Vec low = from_eye(view_, bound.low), high = from_eye(view_, bound.high);
  for (int a = 0; a < 3; ++a) {
    centre[a] = T(0.5F) * low[a] + T(0.5F) * high[a];
    half[a] = (high[a] - centre[a]) * T(1 + 4 * kRoundoff) + T(4 * kRoundoff) * T(abs(centre[a]));
    far_sum = far_sum + (T(abs(centre[a])) + half[a]);
  }
  if (view_.aside) far_sum = far_sum + view_.eye;
  if (view_.eyes > 1) far_sum = far_sum + view_.eyes_apart;
  const auto range_along = [&](int axis) {
    T at = T(0.0F), spread = T(0.0F);
    for (int a = 0; a < 3; ++a) {
      at = at + view_.cam_from_world[axis][a] * centre[a];
      spread = spread + T(abs(view_.cam_from_world[axis][a])) * half[a];
    }
    const T rounding = T(16 * kRoundoff) * far_sum;
    return Interval{at - spread - rounding, at + spread + rounding};
  };
  const T near_plane = constant<T>(kNearPlane);
  const Interval depth = range_along(2);
  if (depth.high < near_plane) return {};
  // Beyond float depth.low may not be a number: then nothing is known.
  const Interval z{depth.low > near_plane ? depth.low : near_plane, depth.high};
  Interval x = range_along(0);
  if (view_.aside) x = {T(x.low - view_.eye), T(x.high - view_.eye)};
  if (view_.eyes > 1) x.low = x.low - view_.eyes_apart;
  const Interval x_ratio = ratio_range(x, z), y_ratio = ratio_range(range_along(1), z);
  const Interval u = clamped(x_ratio, view_.limit_x), w = clamped(y_ratio, view_.limit_y);

  const T u_max = max_of(T(abs(u.low)), T(abs(u.high)));
  const T w_max = max_of(T(abs(w.low)), T(abs(w.high)));
  const T stretch = sqrt_of(T(one + u_max * u_max + w_max * w_max)) * view_.stretch * T(1.00001F);
  const T focal = max_of(view_.focal_x, view_.focal_y);
  const T spread = focal * bound.scale_max * stretch / z.low;
  const T lambda = (spread * spread + constant<T>(kLowPass)) * T(1.0001F);
  const T widening = ellipse_widening(T(T(4.0F) / constant<T>(kLowPass) * lambda));

  T reach_x, reach_y, padding_px;
  if (widening < T(kMaxWidening)) {
    const T factor = sqrt_of(T(one + widening)) * T(1.0002F);
    const Vec* axes = view_.cam_from_world;
    reach_x = factor * reach_along(axes[0], axes[2], u, bound.extent);
    reach_y = factor * reach_along(axes[1], axes[2], w, bound.extent);
    // sqrt(0.3)
    padding_px = factor * constant<T>(kVisibleSigmas) * T(0.5478F) + T(0.05F);
  } else {
    // focal / focal_x or _y: beyond_side multiplies by the focal length of its own axis.
    const T reach = constant<T>(kRadiusSigmas) * bound.scale_max * stretch * T(1.0001F);
    reach_x = reach * focal / view_.focal_x;
    reach_y = reach * focal / view_.focal_y;
    // sqrt(0.3 + sqrt(0.1))
    padding_px = constant<T>(kRadiusSigmas) * T(0.7851F) + one + constant<T>(kTilePx);
  }
  const GroupSides<T>& to = from_middle_;
  const T zero = T(0.0F);
  T of_left = zero, of_right = zero;
  if (view_.aside) {
    of_right = view_.focal_x * view_.eye;
    of_left = -of_right;
  }
  if (view_.eyes > 1) of_right = of_right + view_.focal_x * view_.eyes_apart;
  const bool outside =
      beyond_side(centre, half, 0, one, to.left, padding_px, reach_x, far_sum, of_left) ||
      beyond_side(centre, half, 0, -one, to.right, padding_px, reach_x, far_sum, of_right) ||
      beyond_side(centre, half, 1, one, to.top, padding_px, reach_y, far_sum, zero) ||
      beyond_side(centre, half, 1, -one, to.bottom, padding_px, reach_y, far_sum, zero);
  return {!outside, z, x_ratio, y_ratio, reach_x, reach_y, padding_px};
}

template <class T>
ChunkTestOf<T> GroupFrustumOf<T>::test(const ChunkBoundOf<T>& bound) const {
  const Compared seen = compared(bound);
  if (!seen.touches) return {false, seen.z.low, {}};
  using std::ceil, std::floor;
  const auto subtiles = [&](T middle, T axis_focal, Interval ratio, T reach, T left, T right,
                            int begin) {
    const T around = axis_focal * reach / seen.z.low + seen.padding_px;
    // A value that is not a number leaves the group's own edge.
    const T first =
        max_of(left, min_of(T(ceil(T(middle + axis_focal * ratio.low - around))), right));
    const T last =
        min_of(right, max_of(T(floor(T(middle + axis_focal * ratio.high + around))), left));
    return std::array<std::uint8_t, 2>{subtile_of(first, begin), subtile_of(last, begin)};
  };
  const auto [x0, x1] = subtiles(view_.centre_x, view_.focal_x, seen.x_ratio, seen.reach_x,
                                 outer_.left, outer_.right, pixels_.x0);
  const auto [y0, y1] = subtiles(view_.centre_y, view_.focal_y, seen.y_ratio, seen.reach_y,
                                 outer_.top, outer_.bottom, pixels_.y0);
  return {true, seen.z.low, {x0, y0, x1, y1}};
}

extern template class GroupFrustumOf<float>;

}  // namespace sgs
