// Sampling along a ray with a fixed step, as the VSU of StreamingGS (DAC 2025) does: cheaper than
// the exact traversal, and it can miss the corner of a cell. Points in empty blocks are not sampled
// one by one.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>

#include "algorithm/voxel/ray.h"
#include "algorithm/voxel/voxel_grid.h"

namespace sgs {

// The state of one ray; used as RayPath, a step is a sample taken.
class SamplePath {
 public:
  // step_voxels: distance of samples in units of the voxel size.
  SamplePath(const VoxelFrame& frame, float step_voxels)
      : frame_(frame), step_(static_cast<double>(step_voxels) * frame.voxel_size) {}

  void begin(const Ray& ray) {
    ray_ = ray;
    time_step_ = step_ / glm::length(ray.direction);
    eye_ = eye_cell(ray.origin, frame_);
    last_voxel_ = -1;
    sample_ = first_inside(ray, time_step_);
    now_ = sample_ >= 0 ? Now::kAtSample : Now::kOutside;
  }

  RayEventOf next() {
    switch (now_) {
      case Now::kAtSample:
        if (!cell_at(ray_, static_cast<double>(sample_) * time_step_, cell_)) {
          return {RayEvent::kEnd};
        }
        block_level_ = frame_.levels;
        index_ = 0;
        return {RayEvent::kLookUp, 0};
      case Now::kInNode:
        if (found_ && block_level_ > 0) return {RayEvent::kLookUp, index_};
        if (found_ && index_ != last_voxel_) {
          last_voxel_ = index_;
          return {RayEvent::kVoxel, index_, cells_from_eye(eye_, cell_)};
        }
        return step();
      case Now::kOutside:
        break;
    }
    return {RayEvent::kEnd};
  }

  void give(const VoxelNode& node) {
    const unsigned shift = static_cast<unsigned>(2 * --block_level_);
    const unsigned bit = child_bit((static_cast<unsigned>(cell_.x) >> shift) & 3U,
                                   (static_cast<unsigned>(cell_.y) >> shift) & 3U,
                                   (static_cast<unsigned>(cell_.z) >> shift) & 3U);
    found_ = (node.occupied >> bit & 1U) != 0;
    index_ = node.first_child + static_cast<std::uint32_t>(__builtin_popcountll(
                                    node.occupied & ((std::uint64_t{1} << bit) - 1)));
    now_ = Now::kInNode;
  }

 private:
  enum class Now : std::uint8_t { kAtSample, kInNode, kOutside };

  // An empty block is left in one step; inside an occupied voxel every sample is taken.
  RayEventOf step() {
    const double past = exit_time(ray_, cell_, block_level_) / time_step_;
    if (!(past < 1e15)) {
      now_ = Now::kOutside;
      return {RayEvent::kEnd};
    }
    sample_ =
        found_ ? sample_ + 1 : std::max(sample_ + 1, static_cast<std::int64_t>(std::ceil(past)));
    now_ = Now::kAtSample;
    return {RayEvent::kStep};
  }

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

  VoxelFrame frame_;
  double step_;           // world units
  double time_step_ = 0;  // time along the ray of one step
  Ray ray_{};
  glm::ivec3 eye_{0}, cell_{0};  // relative to the root's corner
  Now now_ = Now::kOutside;
  std::int64_t sample_ = -1, last_voxel_ = -1;
  int block_level_ = 0;      // level of the block that was looked into last
  std::uint32_t index_ = 0;  // index of the child there
  bool found_ = false;       // it is occupied
};

}  // namespace sgs
