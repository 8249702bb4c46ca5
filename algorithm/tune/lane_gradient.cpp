// Loops over lanes, written so that compilers vectorise them.
#include "algorithm/tune/lane_gradient.h"

#include "algorithm/splat/widest_lanes.h"

namespace sgs {
namespace {

template <GradientRule kRule>
[[gnu::always_inline]] inline void add_lanes(const LaneShares& shares, int subtile_x, int subtile_y,
                                             const Splat& s, SubtileAdjoint& adjoint,
                                             LaneMoments& sums) {
  const float left = s.x - static_cast<float>(subtile_x * kSubtilePx);
  const float top = s.y - static_cast<float>(subtile_y * kSubtilePx);
  for (int lane = 0; lane < kSubtilePixels; ++lane) {
    const float dx = left - static_cast<float>(lane % kSubtilePx);
    const float dy = top - static_cast<float>(lane / kSubtilePx);
    const ConicArm<float> arm = conic_arm(s.conic_a, s.conic_b, s.conic_c, dx, dy);
    const float alpha = shares.alpha[lane];
    const float slope = slope_of_alpha<kRule>(
        alpha, [&] { return alpha > 0.0F ? s.opacity * falloff_at(arm, dx, dy) : 0.0F; });
    const float red = adjoint.red[lane], green = adjoint.green[lane], blue = adjoint.blue[lane];
    const float toward = red * s.rgb.x + green * s.rgb.y + blue * s.rgb.z;
    const ShareGradient<float> gradient =
        share_gradient(alpha, shares.before[lane], toward, adjoint.behind[lane], slope);
    adjoint.behind[lane] = gradient.behind;
    const float f = gradient.falloff, fx = f * arm.x, fy = f * arm.y;
    sums.one[lane] += f;
    sums.x[lane] += fx;
    sums.y[lane] += fy;
    sums.xx[lane] += fx * arm.x;
    sums.xy[lane] += fx * arm.y;
    sums.yy[lane] += fy * arm.y;
    sums.red[lane] += gradient.weight * red;
    sums.green[lane] += gradient.weight * green;
    sums.blue[lane] += gradient.weight * blue;
  }
}

[[gnu::always_inline]] inline float sum_of(const float (&lanes)[kSubtilePixels]) {
  float sums[kSubtilePixels / 2];
  for (int lane = 0; lane < 8; ++lane) sums[lane] = lanes[lane] + lanes[lane + 8];
  for (int lane = 0; lane < 4; ++lane) sums[lane] += sums[lane + 4];
  for (int lane = 0; lane < 2; ++lane) sums[lane] += sums[lane + 2];
  return sums[0] + sums[1];
}

}  // namespace

SGS_WIDEST_LANES
void add_gradient(const LaneShares& shares, int subtile_x, int subtile_y, const Splat& splat,
                  SubtileAdjoint& adjoint, LaneMoments& moments) {
  add_lanes<GradientRule::kDerivative>(shares, subtile_x, subtile_y, splat, adjoint, moments);
}

SGS_WIDEST_LANES
void add_original_gradient(const LaneShares& shares, int subtile_x, int subtile_y,
                           const Splat& splat, SubtileAdjoint& adjoint, LaneMoments& moments) {
  add_lanes<GradientRule::kOriginal>(shares, subtile_x, subtile_y, splat, adjoint, moments);
}

SGS_WIDEST_LANES
FalloffMoments<float> total(const LaneMoments& m) {
  return {sum_of(m.one), sum_of(m.x),   sum_of(m.y),     sum_of(m.xx),  sum_of(m.xy),
          sum_of(m.yy),  sum_of(m.red), sum_of(m.green), sum_of(m.blue)};
}

}  // namespace sgs
