// The blending kernel: 16 pixels as 16 lanes, written so that compilers vectorise it. The widest
// variant that the machine has is picked at run time; without fused multiply-adds all give the same
// bits. Leaving early where no lane is hit costs more than it saves.
#include "algorithm/splat/blend.h"

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__)
#define SGS_WIDEST_LANES __attribute__((target_clones("arch=x86-64-v4", "avx2", "default")))
#else
#define SGS_WIDEST_LANES
#endif

namespace sgs {
namespace {
constexpr float kFinish = static_cast<float>(kTransmittanceMin);

// note(lane, alpha, T before) is told of each lane, with alpha 0 where nothing is blended. Inlined,
// so that it is compiled for the same machine as its caller.
template <class Note>
[[gnu::always_inline]] inline void blend_lanes(SubtileState& state, int subtile_x, int subtile_y,
                                               const Splat& splat, const Note& note) {
  const float left = splat.x - static_cast<float>(subtile_x * kSubtilePx);
  const float top = splat.y - static_cast<float>(subtile_y * kSubtilePx);
  const float a = splat.conic_a, b = splat.conic_b, c = splat.conic_c, opacity = splat.opacity;
  const float red = splat.rgb.x, green = splat.rgb.y, blue = splat.rgb.z;
  float alpha[kSubtilePixels];
  for (int lane = 0; lane < kSubtilePixels; ++lane) {
    const float dx = left - static_cast<float>(lane % kSubtilePx);
    const float dy = top - static_cast<float>(lane / kSubtilePx);
    alpha[lane] = alpha_at(a, b, c, opacity, dx, dy);
  }
  for (int lane = 0; lane < kSubtilePixels; ++lane) {
    const float before = state.transmittance[lane];
    const float after = before * (1.0F - alpha[lane]);
    const std::int32_t hit = (alpha[lane] > 0.0F ? -1 : 0) & state.active[lane];
    const std::int32_t ends = hit & (after < kFinish ? -1 : 0);
    const std::int32_t blends = hit & ~ends;
    const float weight = alpha[lane] * before * static_cast<float>(-blends);
    state.red[lane] += red * weight;
    state.green[lane] += green * weight;
    state.blue[lane] += blue * weight;
    state.transmittance[lane] = blends != 0 ? after : before;
    state.active[lane] &= ~ends;
    state.contributors[lane] -= blends;
    note(lane, blends != 0 ? alpha[lane] : 0.0F, before);
  }
}

}  // namespace

SubtileState make_subtile(int subtile_x, int subtile_y, int width_px, int height_px) {
  SubtileState state{};
  for (int lane = 0; lane < kSubtilePixels; ++lane) {
    const int x = subtile_x * kSubtilePx + lane % kSubtilePx;
    const int y = subtile_y * kSubtilePx + lane / kSubtilePx;
    state.transmittance[lane] = 1.0F;
    state.active[lane] = x < width_px && y < height_px ? -1 : 0;
  }
  return state;
}

bool finished(const SubtileState& state) {
  std::int32_t any = 0;
  for (const std::int32_t active : state.active) any |= active;
  return any == 0;
}

SGS_WIDEST_LANES
void blend(SubtileState& state, int subtile_x, int subtile_y, const Splat& splat) {
  blend_lanes(state, subtile_x, subtile_y, splat, [](int, float, float) {});
}

SGS_WIDEST_LANES
LaneShares blend_and_tell(SubtileState& state, int subtile_x, int subtile_y, const Splat& splat) {
  LaneShares shares;
  blend_lanes(state, subtile_x, subtile_y, splat, [&](int lane, float alpha, float before) {
    shares.alpha[lane] = alpha;
    shares.before[lane] = before;
  });
  return shares;
}

}  // namespace sgs
