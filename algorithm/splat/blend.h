// Blending of one splat into pixels: section 3 of the rendering semantics.
#pragma once

#include <cstdint>

#include "algorithm/splat/constants.h"
#include "algorithm/splat/scalar.h"
#include "algorithm/splat/splat.h"

namespace sgs {

// alpha = min(0.99, opacity exp(power)); where power > 0 or alpha < 1/255 the splat is skipped (0),
// also where power is not a number (inf - inf, for splats wider than 10^18 px).
// dx, dy: splat centre minus pixel, px.
template <class T>
inline T alpha_at(T conic_a, T conic_b, T conic_c, T opacity, T dx, T dy) {
  const T power = T(T(-0.5F) * T(conic_a * dx * dx + conic_c * dy * dy) - conic_b * dx * dy);
  const T alpha = min_of(T(opacity * exp_of(power)), constant<T>(kAlphaMax));
  // Two selections rather than one of two conditions: compilers vectorise these.
  const T falling = power > T(0.0F) ? T(0.0F) : alpha;
  return falling >= constant<T>(kAlphaMin) ? falling : T(0.0F);
}

// State of a 4x4 block of pixels; lane = 4 y + x.
struct SubtileState {
  float red[kSubtilePixels], green[kSubtilePixels], blue[kSubtilePixels];
  float transmittance[kSubtilePixels];
  std::int32_t active[kSubtilePixels];        // -1 until T would fall below 1e-4, then 0
  std::int32_t contributors[kSubtilePixels];  // splats blended
};

// In which arithmetic pixels are blended and kept. kHalf: each operation rounded to 16 bits
// (half_scalar.h), the conic and distances of a splat scaled by a power of two of its own, so that
// wide splats do not vanish among the subnormal.
enum class BlendPrecision : std::uint8_t { kSingle, kHalf };

// Fresh state; lanes whose pixel lies outside the frame (width x height px) begin finished.
SubtileState make_subtile(int subtile_x, int subtile_y, int width_px, int height_px);

// What one splat took of the light of each lane.
struct LaneShares {
  float alpha[kSubtilePixels];   // 0 where it was not blended
  float before[kSubtilePixels];  // T in front of it; behind it is the state's
};

// What a splat of this alpha takes of a pixel's light, and what it leaves.
template <class T>
struct LightShare {
  T weight, after;
};
template <class T>
inline LightShare<T> take_light(T alpha, T before) {
  return {T(alpha * before), T(before * T(T(1.0F) - alpha))};
}

// Blends `splat` into the sub-tile (subtile_x, subtile_y) of the frame.
void blend(SubtileState& state, int subtile_x, int subtile_y, const Splat& splat);
void blend_in_half(SubtileState& state, int subtile_x, int subtile_y, const Splat& splat);
// The same, and what the splat took. A function of its own: who does not look pays nothing.
LaneShares blend_and_tell(SubtileState& state, int subtile_x, int subtile_y, const Splat& splat);
LaneShares blend_in_half_and_tell(SubtileState& state, int subtile_x, int subtile_y,
                                  const Splat& splat);

// Whether every pixel of the block is finished.
bool finished(const SubtileState& state);

}  // namespace sgs
