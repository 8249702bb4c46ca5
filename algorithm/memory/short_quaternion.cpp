// Leaving out and computing the largest component.
#include "algorithm/memory/short_quaternion.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <stdexcept>

namespace sgs {
namespace {

constexpr int kUnits = 16;  // a correction is -16 to 15

std::int32_t order_of_bits(float value) { return __builtin_bit_cast(std::int32_t, value); }

// In this order of operations, each rounded to float.
float computed(const std::array<float, 3>& others) {
  float squared = 1.0F;
  for (const float other : others) squared -= other * other;
  return std::sqrt(squared > 0.0F ? squared : 0.0F);
}

}  // namespace

ShortQuaternion shorten(const std::array<float, 4>& quat) {
  std::size_t largest = 0;
  for (std::size_t k = 1; k < 4; ++k) {
    if (std::abs(quat[k]) > std::abs(quat[largest])) largest = k;
  }
  ShortQuaternion out;
  for (std::size_t k = 0, at = 0; k < 4; ++k) {
    if (k != largest) out.others[at++] = quat[k];
  }
  const std::int64_t units = std::int64_t{order_of_bits(std::abs(quat[largest]))} -
                             order_of_bits(computed(out.others));
  if (units < -kUnits || units >= kUnits) {
    throw std::invalid_argument(fmt::format("quaternion: got ({}, {}, {}, {}), expected length 1",
                                            quat[0], quat[1], quat[2], quat[3]));
  }
  out.rest = static_cast<std::uint8_t>(largest | (std::signbit(quat[largest]) ? 4U : 0U) |
                                       static_cast<std::uint32_t>(units + kUnits) << 3);
  return out;
}

std::array<float, 4> lengthen(const ShortQuaternion& quat) {
  const std::size_t largest = quat.rest & 3U;
  const std::int32_t bits = order_of_bits(computed(quat.others)) + (quat.rest >> 3) - kUnits;
  const auto magnitude = __builtin_bit_cast(float, bits);
  std::array<float, 4> out{};
  for (std::size_t k = 0, at = 0; k < 4; ++k) {
    out[k] = k == largest ? ((quat.rest & 4U) != 0 ? -magnitude : magnitude) : quat.others[at++];
  }
  return out;
}

}  // namespace sgs
