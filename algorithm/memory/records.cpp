// Encoding and decoding of Gaussian records.
#include "algorithm/memory/records.h"

#include <cmath>
#include <cstring>

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

}  // namespace sgs
