// The conservative test of a chunk's bound against a pixel group.
#include "algorithm/voxel/chunk_test.h"

namespace sgs {
namespace {

// Sum over the world's axes of |n_a| E_a, at its largest for n = axis - t axis_z with t in [low,
// high]: |n_a| is convex in t, so one of the ends.
float reach_along(const glm::vec3& axis, const glm::vec3& axis_z, float low, float high,
                  const glm::vec3& extent) {
  float sum = 0;
  for (int a = 0; a < 3; ++a) {
    const float n =
        std::max(std::abs(axis[a] - low * axis_z[a]), std::abs(axis[a] - high * axis_z[a]));
    sum += n > 0 ? n * extent[a] : 0;  // an infinite extent along an axis that does not matter
  }
  return sum;
}

struct Interval {
  float low, high;
};

// Range of clamp(v_x / v_z) over a box with v_z in [near, far], near > 0.
Interval ratio_range(Interval x, Interval z, float limit) {
  const float low = x.low >= 0 ? x.low / z.high : x.low / z.low;
  const float high = x.high >= 0 ? x.high / z.low : x.high / z.high;
  constexpr float kRounding = 1e-5F;
  return {std::max(-limit, low - kRounding * (1 + std::abs(low))),
          std::min(limit, high + kRounding * (1 + std::abs(high)))};
}

}  // namespace

bool GroupFrustum::beyond_side(const glm::vec3& centre, const glm::vec3& half, int axis, float sign,
                               float edge_px, float padding_px, float reach, float rounding) const {
  const float focal = axis == 0 ? view_.focal_x : view_.focal_y;
  const float middle = axis == 0 ? view_.centre_x : view_.centre_y;
  const float slope = sign * (middle - edge_px) + padding_px;
  float most = 0;
  for (int a = 0; a < 3; ++a) {
    const float n =
        sign * focal * view_.cam_from_world[axis][a] + slope * view_.cam_from_world[2][a];
    most += n * centre[a] + std::abs(n) * half[a];
  }
  const float slack = 64 * kRoundoff * (focal + std::abs(slope)) * rounding;
  const float margin = most + focal * reach + slack;
  return margin < 0 && std::isfinite(margin);  // a sum that overflowed says nothing
}

ChunkTest GroupFrustum::test(const ChunkBound& bound) const {
  // Box of the centres relative to the camera: middle and half-size, the latter rounded up.
  glm::vec3 centre, half;
  float far_sum = 0;  // largest sum_a |p_a - c_a|
  // from_eye is monotonic in each coordinate: the corners bound what it gives for every centre.
  const glm::vec3 low = from_eye(view_, bound.low), high = from_eye(view_, bound.high);
  for (int a = 0; a < 3; ++a) {
    centre[a] = 0.5F * low[a] + 0.5F * high[a];
    half[a] = (high[a] - centre[a]) * (1 + 4 * kRoundoff) + 4 * kRoundoff * std::abs(centre[a]);
    far_sum += std::abs(centre[a]) + half[a];
  }
  const auto range_along = [&](int axis) {
    float at = 0, spread = 0;
    for (int a = 0; a < 3; ++a) {
      at += view_.cam_from_world[axis][a] * centre[a];
      spread += std::abs(view_.cam_from_world[axis][a]) * half[a];
    }
    const float rounding = 16 * kRoundoff * far_sum;
    return Interval{at - spread - rounding, at + spread + rounding};
  };
  const float near_plane = constant<float>(kNearPlane);
  const Interval depth = range_along(2);
  if (depth.high < near_plane) return {false, 0};
  // Beyond float depth.low may not be a number: then nothing is known.
  const Interval z{depth.low > near_plane ? depth.low : near_plane, depth.high};
  const Interval u = ratio_range(range_along(0), z, view_.limit_x);
  const Interval w = ratio_range(range_along(1), z, view_.limit_y);

  const float u_max = std::max(std::abs(u.low), std::abs(u.high));
  const float w_max = std::max(std::abs(w.low), std::abs(w.high));
  const float stretch = std::sqrt(1 + u_max * u_max + w_max * w_max) * view_.stretch * 1.00001F;
  const float focal = std::max(view_.focal_x, view_.focal_y);
  const float spread = focal * bound.scale_max * stretch / z.low;
  const float lambda = (spread * spread + constant<float>(kLowPass)) * 1.0001F;
  const float widening = ellipse_widening(4 / constant<float>(kLowPass) * lambda);

  float reach_x, reach_y, padding_px;
  if (widening < kMaxWidening) {
    const float factor = std::sqrt(1 + widening) * 1.0002F;
    const glm::vec3* axes = view_.cam_from_world;
    reach_x = factor * reach_along(axes[0], axes[2], u.low, u.high, bound.extent);
    reach_y = factor * reach_along(axes[1], axes[2], w.low, w.high, bound.extent);
    padding_px = factor * constant<float>(kVisibleSigmas) * 0.5478F + 0.05F;  // sqrt(0.3)
  } else {
    // focal / focal_x or _y: beyond_side multiplies by the focal length of its own axis.
    const float reach = constant<float>(kRadiusSigmas) * bound.scale_max * stretch * 1.0001F;
    reach_x = reach * focal / view_.focal_x;
    reach_y = reach * focal / view_.focal_y;
    padding_px = constant<float>(kRadiusSigmas) * 0.7851F + 1 + kTilePx;  // sqrt(0.3 + sqrt(0.1))
  }
  const auto px = [](int at) { return static_cast<float>(at); };
  const bool outside =
      beyond_side(centre, half, 0, 1, px(pixels_.x0), padding_px, reach_x, far_sum) ||
      beyond_side(centre, half, 0, -1, px(pixels_.x1 - 1), padding_px, reach_x, far_sum) ||
      beyond_side(centre, half, 1, 1, px(pixels_.y0), padding_px, reach_y, far_sum) ||
      beyond_side(centre, half, 1, -1, px(pixels_.y1 - 1), padding_px, reach_y, far_sum);
  return {!outside, z.low};
}

}  // namespace sgs
