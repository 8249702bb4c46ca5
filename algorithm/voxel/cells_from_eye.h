// How far a cell lies from the eye: a number that rises along every ray.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <glm/vec3.hpp>

#include "algorithm/voxel/voxel_grid.h"

namespace sgs {

// The eye's cell relative to the root's corner. Where the eye lies beyond the root along an axis,
// the cell next to the root stands for it: all that matters is on which side the root lies.
inline glm::ivec3 eye_cell(const glm::vec3& eye, const VoxelFrame& frame) {
  glm::ivec3 cell;
  for (int axis = 0; axis < 3; ++axis) {
    const int at = cell_of(eye[axis], frame.voxel_size) - frame.origin_cell[axis];
    cell[axis] = std::clamp(at, -1, frame.side_cells());
  }
  return cell;
}

// Manhattan distance of a cell of the root from the eye's: less than 2^22. Each crossing from cell
// to cell moves a ray one step away along one axis, so that it rises along every ray of the frame,
// and an order by distance respects all of them.
inline std::uint32_t cells_from_eye(const glm::ivec3& eye, const glm::ivec3& cell) {
  std::uint32_t sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    sum += static_cast<std::uint32_t>(std::abs(cell[axis] - eye[axis]));
  }
  return sum;
}

}  // namespace sgs
