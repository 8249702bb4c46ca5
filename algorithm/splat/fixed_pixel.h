// Pixels in 16-bit fixed point: light and alpha in units of 2^-16, colours in units of 2^-14, below
// 4, where they stay. Products are of 32 bits and rounded once, half a unit up; what a splat takes
// of the light is what it is missing by afterwards, so none is lost. A half has as many bits and
// fewer digits wherever light is above 2^-5, a colour above 2^-3.
#pragma once

#include <algorithm>
#include <cstdint>

#include "algorithm/splat/constants.h"

namespace sgs {

constexpr std::uint32_t kFixedLight = 1U << 16U;   // units of light in all of it
constexpr std::uint32_t kFixedColour = 1U << 14U;  // units of colour in white
constexpr std::uint32_t kLargestFixedColour = (1U << 16U) - 1;
// The least light that a splat may leave.
constexpr std::uint32_t kFixedTransmittanceMin =
    static_cast<std::uint32_t>(kTransmittanceMin * static_cast<float>(kFixedLight)) + 1;

// value: at least 0. Through signed integers, for which machines have vector instructions.
inline std::uint32_t in_fixed_units(float value, std::uint32_t units) {
  return static_cast<std::uint32_t>(
      static_cast<std::int32_t>(value * static_cast<float>(units) + 0.5F));
}
inline float of_fixed_units(std::uint32_t value, std::uint32_t units) {
  return static_cast<float>(static_cast<std::int32_t>(value)) * (1.0F / static_cast<float>(units));
}

// Keeps the part of a colour that fits: an infinite one becomes the largest, one that is not a
// number becomes 0.
inline std::uint32_t fixed_colour(float colour) {
  constexpr float kLargest =
      static_cast<float>(kLargestFixedColour) / static_cast<float>(kFixedColour);
  return in_fixed_units(colour > 0.0F ? std::min(colour, kLargest) : 0.0F, kFixedColour);
}

// factor: in units of light, at most all of it.
inline std::uint32_t fixed_product(std::uint32_t value, std::uint32_t factor) {
  return (value * factor + kFixedLight / 2) >> 16U;
}

struct FixedShare {
  std::uint32_t weight, after;
};
// alpha: at most kAlphaMax, before: at most all of the light.
inline FixedShare take_fixed_light(std::uint32_t alpha, std::uint32_t before) {
  const std::uint32_t weight = fixed_product(alpha, before);
  return {weight, before - weight};
}

inline std::uint32_t add_fixed_colour(std::uint32_t before, std::uint32_t colour,
                                      std::uint32_t weight) {
  return std::min(before + fixed_product(colour, weight), kLargestFixedColour);
}

}  // namespace sgs
