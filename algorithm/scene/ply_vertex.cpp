// The search for properties; storing, judging and removing of vertices.
#include "algorithm/scene/ply_vertex.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "algorithm/files/input_error.h"
#include "algorithm/scene/gaussian_cloud.h"

namespace sgs {
namespace {

constexpr std::array<const char*, kRestSlot> kNames = {
    "x",       "y",       "z",       "f_dc_0", "f_dc_1", "f_dc_2", "opacity",
    "scale_0", "scale_1", "scale_2", "rot_0",  "rot_1",  "rot_2",  "rot_3"};

// SH degree of a file with `rest` coefficients beside f_dc, or -1.
int degree_of_rest_count(std::size_t rest) {
  constexpr std::array<std::size_t, 4> kRestCounts = {0, 9, 24, 45};
  for (int degree = 0; degree < 4; ++degree) {
    if (kRestCounts[degree] == rest) return degree;
  }
  return -1;
}

}  // namespace

std::string slot_name(int slot) {
  if (slot < kRestSlot) return kNames[slot];
  if (slot == kFilterSlot) return kFilterProperty;
  return fmt::format("f_rest_{}", slot - kRestSlot);
}

VertexLayout layout_of_vertex(const std::string& path, const PlyElement& vertex) {
  std::map<std::string, VertexLayout::Column> by_name;
  std::uint64_t offset_bytes = 0;
  std::size_t rest_count = 0;
  for (std::size_t i = 0; i < vertex.properties.size(); ++i) {
    const PlyProperty& property = vertex.properties[i];
    if (property.is_list) {
      throw InputError(
          fmt::format("{}: element vertex, property {}: got a list, expected scalars only", path,
                      property.name));
    }
    by_name[property.name] = {i, static_cast<std::uint32_t>(offset_bytes), property.type};
    offset_bytes += size_bytes(property.type);
    if (property.name.rfind("f_rest_", 0) == 0) ++rest_count;
  }

  VertexLayout layout;
  layout.record_bytes = offset_bytes;
  layout.sh_degree = degree_of_rest_count(rest_count);
  if (layout.sh_degree < 0) {
    throw InputError(fmt::format(
        "{}: element vertex: got {} properties f_rest_*, expected 0, 9, 24 or 45 (SH "
        "degree 0 to 3){}",
        path, rest_count,
        rest_count == 72 ? "; 72 are SH degree 4: export the scene with degree 3" : ""));
  }
  for (int slot = 0; slot < kRestSlot + static_cast<int>(rest_count); ++slot) {
    const auto found = by_name.find(slot_name(slot));
    if (found == by_name.end()) {
      throw InputError(
          fmt::format("{}: element vertex: got no property {}, expected x y z f_dc_0..2 opacity "
                      "scale_0..2 rot_0..3",
                      path, slot_name(slot)));
    }
    layout.columns.push_back(found->second);
  }
  if (const auto found = by_name.find(kFilterProperty); found != by_name.end()) {
    layout.columns.push_back(found->second);
    layout.has_filter = true;
  }
  return layout;
}

namespace {

constexpr std::uint32_t magnitude_bits(float value) {
  return __builtin_bit_cast(std::uint32_t, value) & 0x7fffffff;
}

// The largest magnitude of each slot as the bits of a float: magnitudes are in the order of their
// bits, and behind the largest come infinity and NaN.
constexpr std::array<std::uint32_t, kMaxSlots> largest_magnitudes() {
  std::array<std::uint32_t, kMaxSlots> largest{};
  for (int slot = 0; slot < kMaxSlots; ++slot) {
    const double limit = slot < kDcSlot        ? kMaxCoordinate
                         : slot < kOpacitySlot ? kMaxCoefficient
                         // Activations make something of infinities, too.
                         : slot < kRotationSlot ? std::numeric_limits<double>::infinity()
                         : slot < kRestSlot     ? std::numeric_limits<float>::max()
                                                : kMaxCoefficient;
    largest[slot] = magnitude_bits(static_cast<float>(limit));
  }
  return largest;
}
constexpr std::array<std::uint32_t, kMaxSlots> kLargest = largest_magnitudes();

// Scales are logarithms, so only their upper end matters: exp makes 0 of the others.
bool is_usable(int slot, float value) {
  const bool is_scale = slot >= kScaleSlot && slot < kScaleSlot + 3;
  return magnitude_bits(value) <= kLargest[slot] &&
         !(is_scale && value > static_cast<float>(kMaxLogScale));
}

// True if all slots are usable. There is no branch a value: the loop takes most of the reader's
// time.
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
  const bool is_scale = fault.slot >= kScaleSlot && fault.slot < kRotationSlot;
  if (fault.slot == kFilterSlot) return fmt::format("a magnitude of at most {}", kMaxScale);
  if (std::isnan(fault.value) && (is_scale || fault.slot == kOpacitySlot)) return "a number";
  if (is_scale) return fmt::format("at most {}, the logarithm of {}", kMaxLogScale, kMaxScale);
  if (!std::isfinite(fault.value)) return "a finite number";
  if (fault.slot < kDcSlot) return fmt::format("a magnitude of at most {}", kMaxCoordinate);
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

void bake_filter(float filter, float* slots) {
  const auto is_faulty = [](float scale) { return !(scale <= static_cast<float>(kMaxLogScale)); };
  if (filter == 0 || std::any_of(slots + kScaleSlot, slots + kRotationSlot, is_faulty)) return;
  const double variance = static_cast<double>(filter) * static_cast<double>(filter);
  double kept = 1;  // of the square of the opacity
  for (int slot = kScaleSlot; slot < kRotationSlot; ++slot) {
    const double scale = std::exp(static_cast<double>(slots[slot]));
    const double wider = scale * scale + variance;
    kept *= scale * scale / wider;
    slots[slot] = static_cast<float>(0.5 * std::log(wider));
  }
  const double opacity = sigmoid(static_cast<double>(slots[kOpacitySlot])) * std::sqrt(kept);
  slots[kOpacitySlot] = static_cast<float>(logit(opacity));
}

namespace {

// One line on `fault`: file, vertex, property, value, what was expected.
std::string describe_fault(const std::string& path, const VertexFault& fault) {
  if (fault.slot == kRotationSlot && fault.value == 0) {
    return fmt::format(
        "{}: vertex {}, properties rot_0..3: got the quaternion 0 0 0 0, expected a length above 0",
        path, fault.vertex);
  }
  return fmt::format("{}: vertex {}, property {}: got {}, expected {}", path, fault.vertex,
                     slot_name(fault.slot), fault.value, expected_of(fault));
}

// The others keep their order.
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

}  // namespace

void settle_faults(const std::string& path, const std::vector<VertexFault>& faults,
                   const SceneReadOptions& options, SceneContents& contents) {
  if (faults.empty()) return;
  if (!options.drop_invalid) throw InputError(describe_fault(path, faults.front()));
  remove_faulty(faults, contents.cloud);
  contents.dropped_invalid = faults.size();
}

}  // namespace sgs
