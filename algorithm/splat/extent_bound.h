// The coarse filter on visible extents: can a Gaussian, of which only the centre, the visible
// half-extents E_a along the world's axes and the largest scale S are known, change a pixel of a
// rectangle?
//
// A splat is blended no farther from its centre x than half_x along x, where half_x is that of
// footprint.h: half_x^2 <= (1 + widening) k^2 cov_a, and 0.02 px more. cov_a = |u1|^2 + 0.3 with
// u1 = (fx / v_z) M^T n, n = axis_x - u axis_z, axes the rows of R^T and u = clamp(v_x / v_z), so
//   k |M^T n| = k sqrt(n^T Sigma n) <= sum_a |n_a| k sqrt(Sigma_aa) <= sum_a |n_a| E_a
// (Sigma_ab^2 <= Sigma_aa Sigma_bb). Hence (half_x - 0.02)^2 <= (1 + widening) (r_x^2 + 0.3
// k_max^2), r_x = (fx / v_z) sum_a |n_a| E_a. Squares are compared with squares: no root is taken.
// Along y alike.
// Widening: with lambda = (f stretch S / v_z)^2 (1 + u^2 + w^2) + 0.3, the condition of the 2D
// covariance is at most 4 lambda / 0.3 (coarse_bound.h). Where the widening by that reaches its
// limit, the footprint may only be cut to tiles: half_x <= ceil(3 sqrt(lambda + sqrt(0.1))) + 16.
// Rounding: x, y, u and w are computed as projection.h computes them, to the bit. There n_a may
// cancel while M is rounded: |u1| is off by at most 16 eps (1 + |u|) (fx / v_z) sum_a sigma_a, and
// n_a here by 2 eps (1 + |u|); 32 eps (1 + limit) sum_a E_a covers both, a constant of the camera.
// The rest loses a few units in the last place of positive sums (1.0005), and x - edge, below 2^18
// px, 2^-7 px beside the 0.02 (0.05).
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "algorithm/splat/footprint.h"
#include "algorithm/splat/rects.h"
#include "algorithm/splat/view.h"

namespace sgs {

template <class T>
struct ExtentBoundOf {
  bool in_front;                       // v_z > near plane
  T depth;                             // v_z
  T x, y;                              // px
  T slack_px;                          // nothing is blended farther from the centre along x than
  T reach_squared_x, reach_squared_y;  // px^2: slack_px + the root of this
};
using ExtentBound = ExtentBoundOf<float>;

template <class T>
ExtentBoundOf<T> extent_bound(const View<T>& view, const glm::vec<3, T>& mean,
                              const glm::vec<3, T>& extent, T scale_max) {
  using std::abs;
  ExtentBoundOf<T> out{};
  const glm::vec<3, T> v = to_camera(view, mean);
  out.depth = v.z;
  out.in_front = v.z > constant<T>(kNearPlane);
  if (!out.in_front) return out;
  const auto pixel = to_pixel(view, v);
  out.x = pixel.x;
  out.y = pixel.y;
  const auto [u, w] = clamped_ratio(view, v);

  // lambda, rounded up, and what widens by it: what depends on the camera alone is one constant.
  const T steepest = T(max_of(view.focal_x, view.focal_y) * view.stretch);
  const T ratio = T(scale_max / v.z);
  const T lambda =
      T(T(T(steepest * steepest) * T(1.00002F)) * T(ratio * ratio) * T(T(1.0F) + u * u + w * w) +
        constant<T>(1.00001 * kLowPass));
  constexpr double kWideningPerLambda = 64.0 * kRoundoff * 4 / kLowPass;
  if (!(lambda < constant<T>(0.9999 * kMaxWidening / kWideningPerLambda))) {
    constexpr double kRadiusExtra = 0.3163;  // sqrt(kMinDiscriminant), rounded up
    constexpr double kNine = 1.0005 * kRadiusSigmas * kRadiusSigmas;
    out.slack_px = T(17.05F);  // rounding up of the radius, a tile, rounding
    out.reach_squared_x = out.reach_squared_y =
        T(constant<T>(kNine) * lambda + constant<T>(kNine * kRadiusExtra));
    return out;
  }
  const T widened = T(T(1.0005F) + constant<T>(1.0006 * kWideningPerLambda) * lambda);
  const T sum = T(extent.x + extent.y + extent.z);
  const auto reach_squared = [&](const glm::vec<3, T>& axis, T t, T limit, T focal_px) {
    const glm::vec<3, T>& z = view.cam_from_world[2];
    const T rounding = T(T(32 * kRoundoff) * T(T(1.0F) + limit));
    const T along =
        T(T(abs(T(axis.x - t * z.x))) * extent.x + T(abs(T(axis.y - t * z.y))) * extent.y +
          T(abs(T(axis.z - t * z.z))) * extent.z + rounding * sum);
    const T reach_px = T(focal_px * T(along / v.z));
    // 0.3 k_max^2, k_max^2 = 2 ln 255 + 1e-4 (visible_cutoff)
    const T low_pass = constant<T>(kLowPass * (kVisibleSigmas * kVisibleSigmas + 1e-4));
    return T(T(reach_px * reach_px + low_pass) * widened);
  };
  out.slack_px = T(0.05F);
  out.reach_squared_x = reach_squared(view.cam_from_world[0], u, view.limit_x, view.focal_x);
  out.reach_squared_y = reach_squared(view.cam_from_world[1], w, view.limit_y, view.focal_y);
  return out;
}

// True if the bound touches a rectangle of pixels.
template <class T>
bool touches(const ExtentBoundOf<T>& bound, const PixelRect& pixels) {
  const auto within = [&](T at, int low, int high, T reach_squared) {
    const T before = T(T(static_cast<float>(low)) - at);
    const T behind = T(at - T(static_cast<float>(high - 1)));
    const T beyond = max_of(T(max_of(before, behind) - bound.slack_px), T(0.0F));
    return T(beyond * beyond) <= reach_squared;
  };
  return within(bound.x, pixels.x0, pixels.x1, bound.reach_squared_x) &&
         within(bound.y, pixels.y0, pixels.y1, bound.reach_squared_y);
}

// Which 4x4 sub-tiles of a pixel group something may change, from what a coarse filter knows of a
// Gaussian. Where all of them are finished it need not be looked at any more.
//
// A splat is blended no farther from its centre than slack + the root of reach_squared along either
// axis (ExtentBound), so the pixel centres p it changes have x - r <= p <= x + r. Rounding: r is
// too large by 2^-9 of itself (root_above), the slack by 0.03 px; x -+ r loses half a unit in the
// last place, 2^-7 px where |x| < 2^18, and farther off, where r > 2^17, less than 2^-9 r.
//
// Sub-tiles [x0, x1] x [y0, y1] relative to the group's corner: 4 B, for groups of up to 1024 px.
// The default is all of them.
struct GroupReach {
  std::uint8_t x0 = 0, y0 = 0, x1 = 255, y1 = 255;
};
static_assert(sizeof(GroupReach) == 4);

// 1 / sqrt(x), 2^-9 to 2^-6.8 of itself too large: what a table with an entry for each parity of
// the exponent and seven bits of the mantissa gives. x: positive and finite.
inline float inverse_root_above(float x) {
  constexpr std::uint32_t kKept = 0xffff0000U;
  const auto floor_of_x = __builtin_bit_cast(float, __builtin_bit_cast(std::uint32_t, x) & kKept);
  return (1.0F + 0x1p-9F) / std::sqrt(floor_of_x);
}

// No less than sqrt(x) (1 + 2^-9), x >= 1: a look-up and a product.
template <class T>
T root_above(T x) {
  if (!(value_of(x) < std::numeric_limits<float>::max())) return x;
  return T(x * inverse_root_above(x));
}

// The column (or row) of a pixel column of the group, as hardware has it once the position is
// whole.
template <class T>
std::uint8_t subtile_of(T px, int begin_px) {
  return static_cast<std::uint8_t>((static_cast<int>(value_of(px)) - begin_px) / kSubtilePx);
}

// First and last pixel column and row of the group that something may change.
template <class T>
struct ReachedPixelsOf {
  T x0, x1, y0, y1;
};

// Those of a bound that touches the group.
template <class T>
ReachedPixelsOf<T> reached_pixels(const ExtentBoundOf<T>& bound, const PixelRect& group) {
  using std::ceil, std::floor;
  const auto along = [&](T at, T reach_squared, int begin, int end) {
    const T reach = T(bound.slack_px + root_above(reach_squared));
    // A value that is not a number leaves the group's own edge.
    return std::array<T, 2>{max_of(T(static_cast<float>(begin)), T(ceil(T(at - reach)))),
                            min_of(T(static_cast<float>(end - 1)), T(floor(T(at + reach))))};
  };
  const auto [x0, x1] = along(bound.x, bound.reach_squared_x, group.x0, group.x1);
  const auto [y0, y1] = along(bound.y, bound.reach_squared_y, group.y0, group.y1);
  return {x0, x1, y0, y1};
}

// What two eyes may change.
template <class T>
ReachedPixelsOf<T> of_both(const ReachedPixelsOf<T>& a, const ReachedPixelsOf<T>& b) {
  return {min_of(a.x0, b.x0), max_of(a.x1, b.x1), min_of(a.y0, b.y0), max_of(a.y1, b.y1)};
}

template <class T>
GroupReach group_reach(const ReachedPixelsOf<T>& pixels, const PixelRect& group) {
  return {subtile_of(pixels.x0, group.x0), subtile_of(pixels.y0, group.y0),
          subtile_of(pixels.x1, group.x0), subtile_of(pixels.y1, group.y0)};
}
template <class T>
GroupReach group_reach(const ExtentBoundOf<T>& bound, const PixelRect& group) {
  return group_reach(reached_pixels(bound, group), group);
}

}  // namespace sgs
