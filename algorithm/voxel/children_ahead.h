// Which children of a node a ray can still meet, and how large the block is in which there are
// none: it is crossed in one step.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "algorithm/voxel/voxel_grid.h"

namespace sgs {

// [axis][place of a child along it, 0 to 3] the children there, one bit each (child_bit).
constexpr std::uint64_t kChildLayers[3][4] = {
    {0x0055005500550055, 0x00aa00aa00aa00aa, 0x5500550055005500, 0xaa00aa00aa00aa00},
    {0x0000333300003333, 0x0000cccc0000cccc, 0x3333000033330000, 0xcccc0000cccc0000},
    {0x000000000f0f0f0f, 0x00000000f0f0f0f0, 0x0f0f0f0f00000000, 0xf0f0f0f000000000}};

// Children at `place` of an axis or, seen along `step` (-1, 0 or 1), behind it.
constexpr std::uint64_t children_from(int axis, int step, unsigned place) {
  std::uint64_t out = kChildLayers[axis][place];
  for (unsigned other = 0; other < 4; ++other) {
    const bool behind = step > 0 ? other > place : step < 0 && other < place;
    if (behind) out |= kChildLayers[axis][other];
  }
  return out;
}

// log2 of the cells a side of the largest block around child `at` of a node in which a ray that has
// done with that child can meet nothing more: the child, its octant of the node, or the node, of
// 4^level cells a side. A ray only ever moves on along `step`.
inline int empty_block(const VoxelNode& node, const glm::uvec3& at, const glm::ivec3& step,
                       int level) {
  const unsigned child = child_bit(at.x, at.y, at.z);
  std::uint64_t ahead = node.occupied & ~(std::uint64_t{1} << child);
  for (int axis = 0; axis < 3; ++axis) ahead &= children_from(axis, step[axis], at[axis]);
  if (ahead == 0) return 2 * level;
  const bool octant_empty = (ahead >> (child & ~7U) & 0xffU) == 0;
  return 2 * (level - 1) + (octant_empty ? 1 : 0);
}

}  // namespace sgs
