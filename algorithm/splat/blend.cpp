// The blending kernel: 16 pixels as 16 lanes, written so that compilers vectorise it. The widest
// variant that the machine has is picked at run time; without fused multiply-adds all give the same
// bits. Leaving early where no lane is hit costs more than it saves.
#include "algorithm/splat/blend.h"

#include <array>

#include "algorithm/splat/fixed_pixel.h"
#include "algorithm/splat/half_scalar.h"
#include "algorithm/splat/square_conic.h"
#include "algorithm/splat/widest_lanes.h"

namespace sgs {
namespace {

auto input_of(const Splat& s, float left, float top) { return blend_input(s, left, top); }
auto input_of(const SquareSplat& s, float left, float top) {
  return blend_input_in_half<HalfScalar>(s, left, top);
}

// of_lane[lane] = column[steps[lane] mod 64], all aligned to 64 B. Permutations of registers: 16
// loads one by one take twice as long as all else of a blend.
[[gnu::always_inline]] inline void look_up_lanes(const float* column, const std::int32_t* steps,
                                                 float* of_lane) {
#if defined(__GNUC__) && !defined(__clang__)
  static_assert(kExp2Rows == 4 * kSubtilePixels);
  using Floats [[gnu::vector_size(64), gnu::may_alias]] = float;
  using Integers [[gnu::vector_size(64), gnu::may_alias]] = std::int32_t;
  const auto* const quarter = reinterpret_cast<const Floats*>(column);
  const Integers at = *reinterpret_cast<const Integers*>(steps);
  const Floats low = __builtin_shuffle(quarter[0], quarter[1], at);
  const Floats high = __builtin_shuffle(quarter[2], quarter[3], at);
  *reinterpret_cast<Floats*>(of_lane) = (at & (kExp2Rows / 2)) != 0 ? high : low;
#else
  for (int lane = 0; lane < kSubtilePixels; ++lane) of_lane[lane] = column[exp2_row(steps[lane])];
#endif
}

float in_float(float x) { return x; }
float in_float(HalfScalar x) { return x.value(); }
void set(float& to, float x) { to = x; }
void set(HalfScalar& to, float x) { to = HalfScalar::exactly(x); }

// exp2_by_table() of every lane, in three steps: the middle one has no vector code that compilers
// find by themselves.
template <class T>
class Exp2Lanes {
 public:
  void put(int lane, T exponent) {
    const Exp2Parts<T> parts = exp2_parts(max_of(exponent, T(kLeastExp2Argument)));
    rest_[lane] = in_float(parts.rest);
    steps_[lane] = parts.steps;
  }
  [[gnu::always_inline]] void look_up() {
    for (std::size_t k = 0; k < kCoefficients; ++k) {
      look_up_lanes(Exp2TableOf<T>::kTable.column[k], steps_, coefficient_[k]);
    }
  }
  T result(int lane) const {
    T rest;
    set(rest, rest_[lane]);
    std::array<T, kCoefficients> coefficient;
    for (std::size_t k = 0; k < kCoefficients; ++k) set(coefficient[k], coefficient_[k][lane]);
    return scaled_by_steps(exp2_polynomial(rest, coefficient), steps_[lane]);
  }

 private:
  static constexpr std::size_t kCoefficients = Exp2TableOf<T>::kCoefficients;

  float rest_[kSubtilePixels];  // compilers do not vectorise copies of a class
  alignas(64) std::int32_t steps_[kSubtilePixels];
  alignas(64) float coefficient_[kCoefficients][kSubtilePixels];
};

// Blends a splat into a pixel whose light and colours are kept as T. note(lane, alpha, T before) is
// told of each lane, with alpha 0 where nothing is blended.
template <class T>
class PixelsIn {
 public:
  template <class Input>
  PixelsIn(const Input& in, const glm::vec3&)
      : red_(in.red), green_(in.green), blue_(in.blue), finish_(constant<T>(kTransmittanceMin)) {}

  template <class Note>
  [[gnu::always_inline]] void blend(SubtileState& state, int lane, T alpha,
                                    const Note& note) const {
    T before, red, green, blue;
    set(before, state.transmittance[lane]);
    set(red, state.red[lane]);
    set(green, state.green[lane]);
    set(blue, state.blue[lane]);
    const LightShare<T> light = take_light(alpha, before);
    const std::int32_t hit = (alpha > T(0.0F) ? -1 : 0) & state.active[lane];
    const std::int32_t ends = hit & (light.after < finish_ ? -1 : 0);
    const std::int32_t blends = hit & ~ends;
    const T weight = blends != 0 ? light.weight : T(0.0F);
    state.red[lane] = in_float(T(red + red_ * weight));
    state.green[lane] = in_float(T(green + green_ * weight));
    state.blue[lane] = in_float(T(blue + blue_ * weight));
    state.transmittance[lane] = in_float(blends != 0 ? light.after : before);
    state.active[lane] &= ~ends;
    state.contributors[lane] -= blends;
    note(lane, blends != 0 ? in_float(alpha) : 0.0F, in_float(before));
  }

 private:
  T red_, green_, blue_, finish_;
};

// The same in fixed point.
class FixedPixels {
 public:
  template <class Input>
  FixedPixels(const Input&, const glm::vec3& rgb)
      : red_(fixed_colour(rgb.x)), green_(fixed_colour(rgb.y)), blue_(fixed_colour(rgb.z)) {}

  template <class Note>
  [[gnu::always_inline]] void blend(SubtileState& state, int lane, HalfScalar alpha,
                                    const Note& note) const {
    const std::uint32_t before = in_fixed_units(state.transmittance[lane], kFixedLight);
    const std::uint32_t opaque = in_fixed_units(alpha.value(), kFixedLight);
    const FixedShare light = take_fixed_light(opaque, before);
    const std::int32_t hit = (opaque != 0 ? -1 : 0) & state.active[lane];
    const std::int32_t ends = hit & (light.after < kFixedTransmittanceMin ? -1 : 0);
    const std::int32_t blends = hit & ~ends;
    const std::uint32_t weight = light.weight & static_cast<std::uint32_t>(blends);
    add(state.red[lane], red_, weight);
    add(state.green[lane], green_, weight);
    add(state.blue[lane], blue_, weight);
    state.transmittance[lane] = of_fixed_units(before - weight, kFixedLight);
    state.active[lane] &= ~ends;
    state.contributors[lane] -= blends;
    note(lane, blends != 0 ? of_fixed_units(opaque, kFixedLight) : 0.0F,
         of_fixed_units(before, kFixedLight));
  }

 private:
  static void add(float& channel, std::uint32_t colour, std::uint32_t weight) {
    const std::uint32_t before = in_fixed_units(channel, kFixedColour);
    channel = of_fixed_units(add_fixed_colour(before, colour, weight), kFixedColour);
  }
  std::uint32_t red_, green_, blue_;
};

// Alpha in T. Inlined, so that it is compiled for the same machine as its caller.
template <class T, class Pixels, class AnySplat, class Note>
[[gnu::always_inline]] inline void blend_lanes(SubtileState& state, int subtile_x, int subtile_y,
                                               const AnySplat& splat, const Note& note) {
  const auto in = input_of(splat, splat.x - static_cast<float>(subtile_x * kSubtilePx),
                           splat.y - static_cast<float>(subtile_y * kSubtilePx));
  const Pixels pixels(in, splat.rgb);
  T exponent[kSubtilePixels], alpha[kSubtilePixels];
  Exp2Lanes<T> exp2;
  for (int lane = 0; lane < kSubtilePixels; ++lane) {
    const T dx = in.left - T(static_cast<float>(lane % kSubtilePx) * in.pixel_x);
    const T dy = in.top - T(static_cast<float>(lane / kSubtilePx) * in.pixel_y);
    exponent[lane] = log2_falloff(in.conic, dx, dy);
    exp2.put(lane, exponent[lane]);
  }
  exp2.look_up();
  for (int lane = 0; lane < kSubtilePixels; ++lane) {
    alpha[lane] = alpha_of(exponent[lane], exp2.result(lane), in.opacity);
  }
  for (int lane = 0; lane < kSubtilePixels; ++lane) pixels.blend(state, lane, alpha[lane], note);
}

template <class T, class Pixels, class AnySplat>
[[gnu::always_inline]] inline LaneShares shares_of(SubtileState& state, int subtile_x,
                                                   int subtile_y, const AnySplat& splat) {
  LaneShares shares;
  blend_lanes<T, Pixels>(state, subtile_x, subtile_y, splat,
                         [&](int lane, float alpha, float before) {
                           shares.alpha[lane] = alpha;
                           shares.before[lane] = before;
                         });
  return shares;
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
  blend_lanes<float, PixelsIn<float>>(state, subtile_x, subtile_y, splat, [](int, float, float) {});
}

SGS_WIDEST_LANES
LaneShares blend_and_tell(SubtileState& state, int subtile_x, int subtile_y, const Splat& splat) {
  return shares_of<float, PixelsIn<float>>(state, subtile_x, subtile_y, splat);
}

SGS_WIDEST_LANES
void blend(SubtileState& state, int subtile_x, int subtile_y, const SquareSplat& splat) {
  blend_lanes<HalfScalar, PixelsIn<HalfScalar>>(state, subtile_x, subtile_y, splat,
                                                [](int, float, float) {});
}

SGS_WIDEST_LANES
LaneShares blend_and_tell(SubtileState& state, int subtile_x, int subtile_y,
                          const SquareSplat& splat) {
  return shares_of<HalfScalar, PixelsIn<HalfScalar>>(state, subtile_x, subtile_y, splat);
}

SGS_WIDEST_LANES
void blend(SubtileState& state, int subtile_x, int subtile_y, const SplatOnFixedPixels& on) {
  blend_lanes<HalfScalar, FixedPixels>(state, subtile_x, subtile_y, on.splat,
                                       [](int, float, float) {});
}

SGS_WIDEST_LANES
LaneShares blend_and_tell(SubtileState& state, int subtile_x, int subtile_y,
                          const SplatOnFixedPixels& on) {
  return shares_of<HalfScalar, FixedPixels>(state, subtile_x, subtile_y, on.splat);
}

}  // namespace sgs
