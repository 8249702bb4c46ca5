// The Gaussian in a PLY vertex: where its parameters stand, how they are stored in a cloud, and
// what is wrong with them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/scene/ply_header.h"

namespace sgs {

// The parameters of one Gaussian in a fixed order of "slots", whatever the order in the file:
// x y z, f_dc_0..2, opacity, scale_0..2, rot_0..3, then f_rest_0.. as in the file, channel-major.
constexpr int kMeanSlot = 0, kDcSlot = 3, kOpacitySlot = 6, kScaleSlot = 7, kRotationSlot = 10,
              kRestSlot = 14, kMaxSlots = 59;

// Name of the property that fills a slot.
std::string slot_name(int slot);

struct VertexLayout {
  struct Column {
    std::size_t property = 0;        // index among the element's properties
    std::uint32_t offset_bytes = 0;  // in a binary record
    PlyScalar type = PlyScalar::kFloat32;
  };
  std::vector<Column> columns;  // one a slot
  int sh_degree = 0;            // 0 to 3, from the number of f_rest
  std::uint64_t record_bytes = 0;
};

// Finds the slots among the properties of `vertex`. Throws InputError that names the property when
// one is missing or a list, or when the count of f_rest fits no SH degree; `path` is for the text.
VertexLayout layout_of_vertex(const std::string& path, const PlyElement& vertex);

// A vertex that cannot be used: the slot with a value that is not finite or beyond
// gaussian_cloud.h, or kRotationSlot with the value 0 when the quaternion has length zero.
struct VertexFault {
  std::uint64_t vertex = 0;
  int slot = 0;
  float value = 0;
};

// Stores the slots of vertex `index` in `cloud` (already resized) and adds to `faults` when they
// cannot be used. Different vertices may be stored from different threads, each with its own
// `faults`.
void store_vertex(const float* slots, std::uint64_t index, GaussianCloud& cloud,
                  std::vector<VertexFault>& faults);

// One line on `fault`: file, vertex, property, value, what was expected.
std::string describe_fault(const std::string& path, const VertexFault& fault);

// Removes the vertices of `faults` (ascending, each once); the others keep their order.
void remove_faulty(const std::vector<VertexFault>& faults, GaussianCloud& cloud);

}  // namespace sgs
