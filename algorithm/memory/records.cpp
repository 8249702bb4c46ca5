// Encoding and decoding of Gaussian records.
#include "algorithm/memory/records.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include "algorithm/splat/gaussian.h"

namespace sgs {
namespace {

void put(std::byte*& out, float value) {
  std::memcpy(out, &value, sizeof value);
  out += sizeof value;
}

float take(const std::byte*& bytes) {
  float value;
  std::memcpy(&value, bytes, sizeof value);
  bytes += sizeof value;
  return value;
}

}  // namespace

int largest_axis(const glm::vec3& scale) {
  int axis = 0;
  for (int k = 1; k < 3; ++k) {
    if (scale[k] > scale[axis]) axis = k;
  }
  return axis;
}

void encode_first_half(const Gaussian<float>& g, std::byte* out) {
  for (int k = 0; k < 3; ++k) put(out, g.mean[k]);
  put(out, g.scale[largest_axis(g.scale)]);
}

FirstHalf decode_first_half(const std::byte* bytes) {
  FirstHalf first{};
  for (int k = 0; k < 3; ++k) first.mean[k] = take(bytes);
  first.scale_max = take(bytes);
  return first;
}

void encode_raw_second_half(const Gaussian<float>& g, const glm::vec3* sh, int sh_degree,
                            std::byte* out) {
  const int axis = largest_axis(g.scale);
  for (int k = 0, other = 0; k < 3; ++k) {
    if (k == axis) continue;
    put(out, std::copysign(g.scale[k], (axis >> other & 1) != 0 ? -1.0F : 1.0F));
    ++other;
  }
  for (const float component : g.quat) put(out, component);
  put(out, g.opacity);
  for (int k = 0; k < (sh_degree + 1) * (sh_degree + 1); ++k) {
    for (int channel = 0; channel < 3; ++channel) put(out, sh[k][channel]);
  }
}

DecodedGaussian decode_raw_second_half(const FirstHalf& first, const std::byte* bytes,
                                       int sh_degree) {
  DecodedGaussian out{};
  out.gaussian.mean = first.mean;
  // The third is for both signs set, which no axis has: whoever restores a scene refuses NaN.
  const float others[3] = {take(bytes), take(bytes), NAN};
  const int axis = (std::signbit(others[0]) ? 1 : 0) | (std::signbit(others[1]) ? 2 : 0);
  for (int k = 0, other = 0; k < 3; ++k) {
    out.gaussian.scale[k] = k == axis ? first.scale_max : std::abs(others[other++]);
  }
  for (float& component : out.gaussian.quat) component = take(bytes);
  out.gaussian.opacity = take(bytes);
  for (int k = 0; k < (sh_degree + 1) * (sh_degree + 1); ++k) {
    for (int channel = 0; channel < 3; ++channel) out.sh[k][channel] = take(bytes);
  }
  return out;
}

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
