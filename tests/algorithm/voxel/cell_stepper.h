// Amanatides and Woo without any hierarchy: from cell to neighbouring cell, over the dense grid.
// The slow reference of RayWalk.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "algorithm/voxel/ray.h"
#include "algorithm/voxel/voxel_grid.h"

namespace sgs::test {

using Cell = std::array<std::int64_t, 3>;

// Cell of each of a cloud's centres, with the voxel id that a grid in Morton order gives it.
class OccupiedCells {
 public:
  // cloud: in storage order.
  OccupiedCells(const ActivatedCloud& cloud, const VoxelGrid& grid) : size_(grid.frame.voxel_size) {
    for (std::uint32_t v = 0; v < grid.voxels.size(); ++v) {
      const Cell cell = cell_at(cloud.gaussians[grid.voxels[v].first].mean);
      voxel_of_[cell] = v;
      for (int axis = 0; axis < 3; ++axis) {
        low_[axis] = v == 0 ? cell[axis] : std::min(low_[axis], cell[axis]);
        high_[axis] = v == 0 ? cell[axis] : std::max(high_[axis], cell[axis]);
      }
    }
  }

  Cell cell_at(const glm::vec3& point) const {
    return {cell_of(point.x, size_), cell_of(point.y, size_), cell_of(point.z, size_)};
  }
  std::size_t count() const { return voxel_of_.size(); }

  // Voxels on the ray, nearest first. One step a cell, through everything between the camera and
  // the far side of the occupied box.
  std::vector<std::uint32_t> walk(const Ray& ray) const {
    std::vector<std::uint32_t> met;
    Cell cell = cell_at(ray.origin);
    while (!beyond(cell, ray)) {
      if (const auto found = voxel_of_.find(cell); found != voxel_of_.end()) {
        met.push_back(found->second);
      }
      int axis = -1;
      float time = 0;
      for (int k = 0; k < 3; ++k) {
        if (ray.step[k] == 0) continue;
        const auto plane = static_cast<int>(cell[k] + (ray.step[k] > 0 ? 1 : 0));
        const float crossing = ray.plane_time(k, plane, size_);
        if (axis < 0 || crosses_before(crossing, k, time, axis)) {
          axis = k;
          time = crossing;
        }
      }
      if (axis < 0) break;  // a ray that stands still
      cell[axis] += ray.step[axis];
    }
    return met;
  }

 private:
  // Whether the ray has passed the occupied box along some axis, or never comes nearer.
  bool beyond(const Cell& cell, const Ray& ray) const {
    for (int axis = 0; axis < 3; ++axis) {
      if (cell[axis] > high_[axis] && ray.step[axis] >= 0) return true;
      if (cell[axis] < low_[axis] && ray.step[axis] <= 0) return true;
    }
    return voxel_of_.empty();
  }

  float size_;
  Cell low_{}, high_{};
  std::map<Cell, std::uint32_t> voxel_of_;
};

}  // namespace sgs::test
