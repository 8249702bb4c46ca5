// Values of PLY vertices on their way into a GaussianCloud, and what is wrong with them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "algorithm/scene/gaussian_cloud.h"

namespace sgs {

// A vertex that cannot be used: the slot (vertex_layout.h) with a value that is not finite or
// beyond gaussian_limits.h, or kRotationSlot with the value 0 when the quaternion has length zero.
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
