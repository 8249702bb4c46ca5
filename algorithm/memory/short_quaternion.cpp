// Leaving out and computing the largest component.
#include "algorithm/memory/short_quaternion.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include "algorithm/splat/gaussian.h"

namespace sgs {
namespace {

constexpr int kUnits = 16;  // a correction is -16 to 15

std::int32_t order_of_bits(float value) { return __builtin_bit_cast(std::int32_t, value); }

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
                             order_of_bits(largest_component(out.others));
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
  const float magnitude = moved_by_units(largest_component(quat.others), (quat.rest >> 3) - kUnits);
  std::array<float, 4> out{};
  for (std::size_t k = 0, at = 0; k < 4; ++k) {
    out[k] = k == largest ? ((quat.rest & 4U) != 0 ? -magnitude : magnitude) : quat.others[at++];
  }
  return out;
}

}  // namespace sgs
