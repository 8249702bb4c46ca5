// Storing, judging and removing of vertex_store.h.
#include "algorithm/scene/vertex_store.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>

#include "algorithm/scene/gaussian_limits.h"
#include "algorithm/scene/vertex_layout.h"

namespace sgs {
namespace {

constexpr std::uint32_t magnitude_bits(float value) {
  return __builtin_bit_cast(std::uint32_t, value) & 0x7fffffff;
}

// The largest magnitude of each slot as the bits of a float: magnitudes are in the order of their
// bits, and behind the largest come infinity and NaN.
constexpr std::array<std::uint32_t, kMaxSlots> largest_magnitudes() {
  std::array<std::uint32_t, kMaxSlots> largest{};
  for (int slot = 0; slot < kMaxSlots; ++slot) {
    const bool finite_is_enough = slot >= kOpacitySlot && slot < kRestSlot;
    const double limit = slot < kDcSlot ? kMaxCoordinate : kMaxCoefficient;
    largest[slot] = magnitude_bits(finite_is_enough ? std::numeric_limits<float>::max()
                                                    : static_cast<float>(limit));
  }
  return largest;
}
constexpr std::array<std::uint32_t, kMaxSlots> kLargest = largest_magnitudes();

// Of scales, which are logarithms, only the upper end matters: exp makes 0 of the others.
bool is_usable(int slot, float value) {
  const bool is_scale = slot >= kScaleSlot && slot < kScaleSlot + 3;
  return magnitude_bits(value) <= kLargest[slot] &&
         !(is_scale && value > static_cast<float>(kMaxLogScale));
}

// Whether all slots are, without a branch a value: the loop is most of the reader's work.
bool all_usable(const float* slots, int count) {
  std::int32_t any_bad = 0;
  for (int slot = 0; slot < count; ++slot) {
    any_bad |= static_cast<std::int32_t>(magnitude_bits(slots[slot]) > kLargest[slot]);
  }
  for (int slot = kScaleSlot; slot < kScaleSlot + 3; ++slot) {
    any_bad |= static_cast<std::int32_t>(slots[slot] > static_cast<float>(kMaxLogScale));
  }
  return any_bad == 0;
}

bool is_zero_quaternion(const float* rotation) {
  return rotation[0] == 0 && rotation[1] == 0 && rotation[2] == 0 && rotation[3] == 0;
}

std::string expected_of(const VertexFault& fault) {
  if (!std::isfinite(fault.value)) return "a finite number";
  if (fault.slot < kDcSlot) return fmt::format("a magnitude of at most {}", kMaxCoordinate);
  if (fault.slot >= kScaleSlot && fault.slot < kRotationSlot) {
    return fmt::format("at most {}, the logarithm of {}", kMaxLogScale, kMaxScale);
  }
  return fmt::format("a magnitude of at most {}", kMaxCoefficient);
}

}  // namespace

void store_vertex(const float* slots, std::uint64_t index, GaussianCloud& cloud,
                  std::vector<VertexFault>& faults) {
  const int coeffs = sh_coeff_count(cloud.sh_degree), rest = coeffs - 1;
  const float *mean = slots + kMeanSlot, *dc = slots + kDcSlot, *scale = slots + kScaleSlot,
              *rotation = slots + kRotationSlot, *red = slots + kRestSlot, *green = red + rest,
              *blue = green + rest;
  cloud.means[index] = {mean[0], mean[1], mean[2]};
  cloud.log_scales[index] = {scale[0], scale[1], scale[2]};
  cloud.quats[index] = {rotation[0], rotation[1], rotation[2], rotation[3]};
  cloud.opacity_logits[index] = slots[kOpacitySlot];
  glm::vec3* sh = &cloud.sh_coeffs[index * static_cast<std::uint64_t>(coeffs)];
  sh[0] = {dc[0], dc[1], dc[2]};
  for (int k = 0; k < rest; ++k) sh[k + 1] = {red[k], green[k], blue[k]};

  const int slot_count = kRestSlot + 3 * rest;
  if (!all_usable(slots, slot_count)) {
    int slot = 0;
    while (is_usable(slot, slots[slot])) ++slot;
    faults.push_back({index, slot, slots[slot]});
  } else if (is_zero_quaternion(rotation)) {
    faults.push_back({index, kRotationSlot, 0.0f});
  }
}

std::string describe_fault(const std::string& path, const VertexFault& fault) {
  if (fault.slot == kRotationSlot && fault.value == 0) {
    return fmt::format(
        "{}: vertex {}, properties rot_0..3: got the quaternion 0 0 0 0, expected a length above 0",
        path, fault.vertex);
  }
  return fmt::format("{}: vertex {}, property {}: got {}, expected {}", path, fault.vertex,
                     slot_name(fault.slot), fault.value, expected_of(fault));
}

void remove_faulty(const std::vector<VertexFault>& faults, GaussianCloud& cloud) {
  const auto coeffs = static_cast<std::size_t>(sh_coeff_count(cloud.sh_degree));
  std::size_t kept = 0;
  auto fault = faults.begin();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (fault != faults.end() && fault->vertex == i) {
      ++fault;
      continue;
    }
    cloud.means[kept] = cloud.means[i];
    cloud.log_scales[kept] = cloud.log_scales[i];
    cloud.quats[kept] = cloud.quats[i];
    cloud.opacity_logits[kept] = cloud.opacity_logits[i];
    for (std::size_t k = 0; k < coeffs; ++k) {
      cloud.sh_coeffs[kept * coeffs + k] = cloud.sh_coeffs[i * coeffs + k];
    }
    ++kept;
  }
  cloud.resize(kept, cloud.sh_degree);
}

}  // namespace sgs
