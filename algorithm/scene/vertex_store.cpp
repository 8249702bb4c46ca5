// Storing, judging and removing of vertex_store.h.
#include "algorithm/scene/vertex_store.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>

#include "algorithm/scene/vertex_layout.h"

namespace sgs {
namespace {

// Whether all slots are finite, without a branch a value: the loop is most of the reader's work.
bool all_finite(const float* slots, int count) {
  constexpr std::uint32_t kExponent = 0x7f800000;
  std::uint32_t any_bad = 0;
  for (int slot = 0; slot < count; ++slot) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &slots[slot], sizeof bits);
    any_bad |= static_cast<std::uint32_t>((bits & kExponent) == kExponent);
  }
  return any_bad == 0;
}

bool is_zero_quaternion(const float* rotation) {
  return rotation[0] == 0 && rotation[1] == 0 && rotation[2] == 0 && rotation[3] == 0;
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
  if (!all_finite(slots, slot_count)) {
    int slot = 0;
    while (std::isfinite(slots[slot])) ++slot;
    faults.push_back({index, slot, slots[slot]});
  } else if (is_zero_quaternion(rotation)) {
    faults.push_back({index, kRotationSlot, 0.0f});
  }
}

std::string describe_fault(const std::string& path, const VertexFault& fault) {
  if (std::isfinite(fault.value)) {
    return fmt::format(
        "{}: vertex {}, properties rot_0..3: got the quaternion 0 0 0 0, expected a length above 0",
        path, fault.vertex);
  }
  return fmt::format("{}: vertex {}, property {}: got {}, expected a finite number", path,
                     fault.vertex, slot_name(fault.slot), fault.value);
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
