// Blending of one splat into pixels: section 3 of the rendering semantics.
#pragma once

#include <cstdint>

#include "algorithm/splat/constants.h"
#include "algorithm/splat/exp2.h"
#include "algorithm/splat/scalar.h"
#include "algorithm/splat/splat.h"
#include "algorithm/splat/square_splat.h"

namespace sgs {

// The conic with log2(e) in it, once a splat: a dx^2 + c dy^2 + b dx dy is the exponent of 2.
template <class T>
struct Log2Conic {
  T a, b, c;
};
template <class T>
inline Log2Conic<T> log2_conic(T conic_a, T conic_b, T conic_c) {
  return {T(conic_a * constant<T>(-0.5 * kLog2E)), T(conic_b * constant<T>(-kLog2E)),
          T(conic_c * constant<T>(-0.5 * kLog2E))};
}

// log2 of exp(power), power = -(A dx^2 + C dy^2)/2 - B dx dy. dx, dy: splat centre minus pixel, px.
template <class T>
inline T log2_falloff(const Log2Conic<T>& conic, T dx, T dy) {
  return T(T(conic.a * dx * dx + conic.c * dy * dy) + conic.b * dx * dy);
}

// alpha = min(0.99, opacity exp(power)); where power > 0 or alpha < 1/255 the splat is skipped (0),
// also where power is not a number (inf - inf, for splats wider than 10^18 px).
template <class T>
inline T alpha_of(T log2_falloff, T falloff, T opacity) {
  const T alpha = min_of(T(opacity * falloff), constant<T>(kAlphaMax));
  // Two selections rather than one of two conditions: compilers vectorise these.
  const T falling = log2_falloff > T(0.0F) ? T(0.0F) : alpha;
  return falling >= constant<T>(kAlphaMin) ? falling : T(0.0F);
}

template <class T>
inline T alpha_at(T conic_a, T conic_b, T conic_c, T opacity, T dx, T dy) {
  const T exponent = log2_falloff(log2_conic(conic_a, conic_b, conic_c), dx, dy);
  return alpha_of(exponent, exp2_of(exponent), opacity);
}

// State of a 4x4 block of pixels; lane = 4 y + x.
struct SubtileState {
  float red[kSubtilePixels], green[kSubtilePixels], blue[kSubtilePixels];
  float transmittance[kSubtilePixels];
  std::int32_t active[kSubtilePixels];        // -1 until T would fall below 1e-4, then 0
  std::int32_t contributors[kSubtilePixels];  // splats blended
};

// In which arithmetic pixels are blended and kept. kHalf: each operation rounded to 16 bits
// (half_scalar.h), the conic with its square completed (square_conic.h; once a splat, in single
// precision), it and distances scaled by powers of two of the splat's own, so that wide splats do
// not vanish among the subnormal. kFixed: alpha as in kHalf, light and colours of pixels in fixed
// point (fixed_pixel.h).
enum class BlendPrecision : std::uint8_t { kSingle, kHalf, kFixed };

// Whether the exponent and alpha are halves, and what is kept of a pixel has 16 bits a number.
constexpr bool in_16_bits(BlendPrecision precision) { return precision != BlendPrecision::kSingle; }

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
  const T weight = T(alpha * before);
  return {weight, T(before - weight)};
}

// Blends `splat` into the sub-tile (subtile_x, subtile_y) of the frame.
void blend(SubtileState& state, int subtile_x, int subtile_y, const Splat& splat);
// In half.
void blend(SubtileState& state, int subtile_x, int subtile_y, const SquareSplat& splat);
// On pixels in fixed point.
struct SplatOnFixedPixels {
  SquareSplat splat;
};
void blend(SubtileState& state, int subtile_x, int subtile_y, const SplatOnFixedPixels& splat);
// The same, and what the splat took. A function of its own: who does not look pays nothing.
LaneShares blend_and_tell(SubtileState& state, int subtile_x, int subtile_y, const Splat& splat);
LaneShares blend_and_tell(SubtileState& state, int subtile_x, int subtile_y,
                          const SquareSplat& splat);
LaneShares blend_and_tell(SubtileState& state, int subtile_x, int subtile_y,
                          const SplatOnFixedPixels& splat);

// Whether every pixel of the block is finished.
bool finished(const SubtileState& state);

}  // namespace sgs
