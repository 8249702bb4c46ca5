// Sampling along a ray with a fixed step, as the paper's VSU does: cheaper than the exact
// traversal, and it can miss the corner of a cell. Points in empty blocks are not sampled one by
// one.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>

#include "algorithm/voxel/cells_from_eye.h"
#include "algorithm/voxel/ray.h"
#include "algorithm/voxel/voxel_grid.h"

namespace sgs {

template <class Table>
class RaySampling {
 public:
  // step_voxels: distance of samples in units of the voxel size.
  RaySampling(const VoxelFrame& frame, Table& table, float step_voxels)
      : frame_(frame), table_(table), step_(static_cast<double>(step_voxels) * frame.voxel_size) {}

  // As RayWalk::walk; a step is a sample taken.
  template <class Visit>
  std::uint32_t walk(const Ray& ray, Visit&& visit) {
    const double time_step = step_ / glm::length(ray.direction);
    std::uint32_t steps = 0;
    std::int64_t sample = first_inside(ray, time_step);
    std::int64_t last_voxel = -1;
    const glm::ivec3 eye = eye_cell(ray.origin, frame_);
    while (sample >= 0) {
      ++steps;
      glm::ivec3 cell;
      if (!cell_at(ray, static_cast<double>(sample) * time_step, cell)) return steps;
      int block_level = frame_.levels;
      std::uint32_t index = 0;
      bool found = true;
      while (found && block_level > 0) {
        const VoxelNode node = table_.node(index);
        const unsigned shift = static_cast<unsigned>(2 * --block_level);
        const unsigned bit = child_bit((static_cast<unsigned>(cell.x) >> shift) & 3U,
                                       (static_cast<unsigned>(cell.y) >> shift) & 3U,
                                       (static_cast<unsigned>(cell.z) >> shift) & 3U);
        found = (node.occupied >> bit & 1U) != 0;
        index = node.first_child + static_cast<std::uint32_t>(__builtin_popcountll(
                                       node.occupied & ((std::uint64_t{1} << bit) - 1)));
      }
      if (found && index != last_voxel) {
        if (!visit(index, cells_from_eye(eye, cell))) return steps;
        last_voxel = index;
      }
      const double past = exit_time(ray, cell, block_level) / time_step;
      if (!(past < 1e15)) return steps;
      // An empty block is left in one step; inside an occupied voxel every sample is taken.
      sample =
          found ? sample + 1 : std::max(sample + 1, static_cast<std::int64_t>(std::ceil(past)));
    }
    return steps;
  }

 private:
  bool cell_at(const Ray& ray, double time, glm::ivec3& cell) const {
    for (int axis = 0; axis < 3; ++axis) {
      const double at = ray.origin[axis] + time * ray.direction[axis];
      const double relative = std::floor(at / frame_.voxel_size) - frame_.origin_cell[axis];
      if (!(relative >= 0 && relative < frame_.side_cells())) return false;
      cell[axis] = static_cast<int>(relative);
    }
    return true;
  }

  double exit_time(const Ray& ray, const glm::ivec3& cell, int level) const {
    const int size = 1 << (2 * level);
    float time = std::numeric_limits<float>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      const int low = cell[axis] & ~(size - 1);
      const int plane = (ray.step[axis] > 0 ? low + size : low) + frame_.origin_cell[axis];
      time = std::min(time, ray.plane_time(axis, plane, frame_.voxel_size));
    }
    return time;
  }

  // First sample inside the root, or -1.
  std::int64_t first_inside(const Ray& ray, double time_step) const {
    double enter = 0, leave = 1e30;
    for (int axis = 0; axis < 3; ++axis) {
      const double low = static_cast<double>(frame_.origin_cell[axis]) * frame_.voxel_size;
      const double high = low + static_cast<double>(frame_.side_cells()) * frame_.voxel_size;
      const double at = ray.origin[axis];
      if (ray.step[axis] == 0) {
        if (at < low || at >= high) return -1;
        continue;
      }
      const double a = (low - at) / ray.direction[axis], b = (high - at) / ray.direction[axis];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    if (enter > leave) return -1;
    std::int64_t sample = static_cast<std::int64_t>(std::ceil(enter / time_step));
    glm::ivec3 cell;
    // Rounding may put the first sample a hair outside.
    return cell_at(ray, static_cast<double>(sample) * time_step, cell) ? sample : sample + 1;
  }

  const VoxelFrame frame_;
  Table& table_;
  const double step_;  // world units
};

}  // namespace sgs
