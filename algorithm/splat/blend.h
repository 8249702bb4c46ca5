// Blending of one splat into pixels: section 3 of the rendering semantics.
#pragma once

#include <cmath>
#include <cstdint>

#include "algorithm/splat/constants.h"
#include "algorithm/splat/exp2.h"
#include "algorithm/splat/scalar.h"
#include "algorithm/splat/splat.h"
#include "algorithm/splat/square_conic.h"

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
  const T uncut = T(opacity * falloff);
  const T alpha = min_of(uncut, constant<T>(kAlphaMax));
  // Two selections rather than one of two conditions: compilers vectorise these. The second asks
  // what the first minimum is of, so that hardware need not wait for it.
  const T falling = log2_falloff > T(0.0F) ? T(0.0F) : alpha;
  return uncut >= constant<T>(kAlphaMin) ? falling : T(0.0F);
}

template <class T>
inline T alpha_at(T conic_a, T conic_b, T conic_c, T opacity, T dx, T dy) {
  const T exponent = log2_falloff(log2_conic(conic_a, conic_b, conic_c), dx, dy);
  return alpha_of(exponent, exp2_of(exponent), opacity);
}

// A splat as the arithmetic of blending takes it, beside a sub-tile's first pixel. Conic:
// Log2Conic<T>, or SquareConic<T>.
template <class T, class Conic>
struct BlendInput {
  Conic conic;
  T opacity, red, green, blue;
  T left, top;             // splat centre minus the sub-tile's first pixel
  float pixel_x, pixel_y;  // distance of neighbours, in the same units
};

// left, top: px. Blending in the scalar that the splat is given in.
template <class S>
BlendInput<S, Log2Conic<S>> blend_input(const SplatOf<S>& s, S left, S top) {
  return {log2_conic(s.conic_a, s.conic_b, s.conic_c),
          s.opacity,
          s.rgb.x,
          s.rgb.y,
          s.rgb.z,
          left,
          top,
          1.0F,
          1.0F};
}

// In the half H. Lengths along x are in units of their own, and so are those along y.
template <class H, class S>
BlendInput<H, SquareConic<H>> blend_input_in_half(const SquareSplatOf<S>& s, S left, S top) {
  const AxisUnits units = axis_units(s.conic);
  const SquareConic<S> conic = in_units(s.conic, units);
  return {{H(conic.a), H(conic.lean), H(conic.rest)},
          narrowed<H>(s.opacity),
          narrowed<H>(s.rgb.x),
          narrowed<H>(s.rgb.y),
          narrowed<H>(s.rgb.z),
          H(scaled_by(left, units.x)),
          H(scaled_by(top, units.y)),
          units.x,
          units.y};
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

// True if the exponent and alpha are halves, and a pixel's state has 16 bits a number.
constexpr bool in_16_bits(BlendPrecision precision) { return precision != BlendPrecision::kSingle; }

// Fresh state; pixels that lie outside the frame (width x height px) begin finished.
SubtileState make_subtile(int subtile_x, int subtile_y, int width_px, int height_px);

// The alpha of one splat in each pixel, and the transmittance T in front of it.
struct LaneShares {
  float alpha[kSubtilePixels];   // 0 where it was not blended
  float before[kSubtilePixels];  // T in front of it; behind it is the state's
};

// The share of a pixel's light that a splat of this alpha takes, and the light that it leaves.
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

// True if every pixel of the block is finished.
bool finished(const SubtileState& state);

// From the state of a pixel to the frame: one channel of C + T background.
template <class T>
T over_background(T colour, T transmittance, T background) {
  return T(colour + transmittance * background);
}

// A channel as a whole number of 8 bits.
template <class T>
T level_of(T channel) {
  using std::round;
  return T(round(T(T(255.0F) * clamp_of(channel, T(0.0F), T(1.0F)))));
}

}  // namespace sgs
