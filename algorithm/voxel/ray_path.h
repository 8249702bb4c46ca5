// Traversal of the occupied voxels along a ray: Amanatides and Woo, "A Fast Voxel Traversal
// Algorithm for Ray Tracing" (1987), with empty blocks of the sparse tree crossed in one step, of
// 1, 2 or 4 children a side.
// Gives the very sequence of cells that stepping cell by cell through the dense grid would.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>
#include <type_traits>

#include "algorithm/voxel/cells_from_eye.h"
#include "algorithm/voxel/children_ahead.h"
#include "algorithm/voxel/ray.h"
#include "algorithm/voxel/ray_event.h"
#include "algorithm/voxel/voxel_grid.h"

namespace sgs {

// Nodes that a ray keeps of those from the root to where it is: the lowest. One that climbs above
// them comes down from the root again.
constexpr int kNodesOfRay = 3;

// A path is the state of one ray: what a unit keeps of each that it follows.
template <class T = float>
class RayPath {
 public:
  explicit RayPath(const VoxelFrame& frame) : RayPath(frame, T(frame.voxel_size)) {}
  // voxel_size: the frame's, as a value of the datapath.
  RayPath(const VoxelFrame& frame, T voxel_size) : frame_(frame), voxel_size_(voxel_size) {}

  // Puts the ray into the tree.
  void begin(const RayOf<T>& ray) {
    ray_ = ray;
    eye_ =
        eye_cell({value_of(ray.origin.x), value_of(ray.origin.y), value_of(ray.origin.z)}, frame_);
    now_ = enter() ? Now::kAtRoot : Now::kOutside;
  }

  // Goes on to the next event.
  RayEventOf next() {
    switch (now_) {
      case Now::kAtRoot:
        level_ = highest_ = frame_.levels;
        return {RayEvent::kLookUp, 0};
      case Now::kInNode:
        return look();
      case Now::kAtVoxel:
        break;
      case Now::kOutside:
        return {RayEvent::kEnd};
    }
    return step();
  }

  // The node that was asked for.
  void give(const VoxelNode& node) {
    node_at(level_) = node;
    highest_ = std::min(highest_, level_ + kNodesOfRay - 1);
    now_ = Now::kInNode;
  }

 private:
  enum class Now : std::uint8_t { kAtRoot, kInNode, kAtVoxel, kOutside };

  VoxelNode& node_at(int level) { return nodes_[level % kNodesOfRay]; }

  // Place of the cell among the children of the node.
  glm::uvec3 place() const {
    return glm::uvec3(cell_) >> static_cast<unsigned>(2 * (level_ - 1)) & 3U;
  }

  RayEventOf look() {
    const VoxelNode& node = node_at(level_);
    const glm::uvec3 at = place();
    const unsigned bit = child_bit(at.x, at.y, at.z);
    if ((node.occupied >> bit & 1U) == 0) return step();
    const std::uint64_t below = (std::uint64_t{1} << bit) - 1;
    const std::uint32_t child =
        node.first_child + static_cast<std::uint32_t>(__builtin_popcountll(node.occupied & below));
    if (level_ > 1) {
      --level_;
      return {RayEvent::kLookUp, child};
    }
    now_ = Now::kAtVoxel;
    return {RayEvent::kVoxel, child, cells_from_eye(eye_, cell_)};
  }

  // Out of the largest block in which nothing is ahead.
  RayEventOf step() {
    const glm::ivec3 from = cell_;
    const int log2_size = empty_block(node_at(level_), place(), ray_.step, level_);
    leave_block(log2_size);
    now_ = outside() ? Now::kOutside : Now::kInNode;
    if (now_ == Now::kInNode) {
      // Climb to the smallest node that holds the old cell and the new one.
      const auto differs =
          static_cast<unsigned>((from.x ^ cell_.x) | (from.y ^ cell_.y) | (from.z ^ cell_.z));
      while (differs >> (2 * level_) != 0) ++level_;
      if (level_ > highest_) now_ = Now::kAtRoot;
    }
    return {RayEvent::kStep, static_cast<std::uint32_t>(log2_size)};
  }

  // In which a position along a ray is computed from its time.
  using Wide = std::conditional_t<std::is_same_v<T, float>, double, T>;
  static Wide wide(int value) {
    if constexpr (std::is_same_v<Wide, double>) {
      return value;
    } else {
      return Wide(static_cast<float>(value));
    }
  }

  bool outside() const {
    const auto side = static_cast<unsigned>(frame_.side_cells());
    return static_cast<unsigned>(cell_.x) >= side || static_cast<unsigned>(cell_.y) >= side ||
           static_cast<unsigned>(cell_.z) >= side;
  }

  // Time at which the ray crosses the plane below `cell` (relative to the root) of an axis.
  T plane_time(int axis, int cell) const {
    return ray_.plane_time(axis, cell + frame_.origin_cell[axis], voxel_size_);
  }

  // Cell along `axis` when the ray crosses another axis' plane at `time`, between `from` and `last`
  // (in the direction of travel): all planes crossed before count.
  int cell_when(int axis, T time, int crossed_axis, int from, int last) const {
    const int step = ray_.step[axis];
    if (step == 0 || from == last) return from;
    using std::floor;
    const Wide position =
        (Wide(ray_.origin[axis]) + Wide(time) * Wide(ray_.direction[axis])) / Wide(voxel_size_);
    const Wide relative = floor(position) - wide(frame_.origin_cell[axis]);
    const int low = std::min(from, last), high = std::max(from, last);
    int cell = static_cast<int>(clamp_of(relative, wide(low), wide(high)));
    const int far_side = step > 0 ? 1 : 0;  // plane by which a cell is left
    const auto left_before = [&](int c) {
      return crosses_before(plane_time(axis, c + far_side), axis, time, crossed_axis);
    };
    while (cell != last && left_before(cell)) cell += step;
    while (cell != from && !left_before(cell - step)) cell -= step;
    return cell;
  }

  // Moves to the first cell beyond the block of 2^log2_size cells a side that holds the current
  // one.
  void leave_block(int log2_size) {
    const int size = 1 << log2_size;
    int exit_axis = 0;
    T exit_time = T(std::numeric_limits<float>::infinity());
    glm::ivec3 last;
    for (int axis = 0; axis < 3; ++axis) {
      const int low = cell_[axis] & ~(size - 1);
      last[axis] = ray_.step[axis] > 0 ? low + size - 1 : low;
      const T time = plane_time(axis, ray_.step[axis] > 0 ? low + size : low);
      if (axis == 0 || time < exit_time) {
        exit_time = time;
        exit_axis = axis;
      }
    }
    if (ray_.step[exit_axis] == 0) {  // a direction of zero length never leaves
      cell_.x = -1;
      return;
    }
    for (int axis = 0; axis < 3; ++axis) {
      if (axis != exit_axis) {
        cell_[axis] = cell_when(axis, exit_time, exit_axis, cell_[axis], last[axis]);
      }
    }
    cell_[exit_axis] = last[exit_axis] + ray_.step[exit_axis];
  }

  // Puts the ray into the camera's cell or, from outside, into the first cell of the root.
  bool enter() {
    const int side = frame_.side_cells();
    T entry_time = T(0.0F);
    int entry_axis = -1;
    for (int axis = 0; axis < 3; ++axis) {
      cell_[axis] =
          cell_of(value_of(ray_.origin[axis]), frame_.voxel_size) - frame_.origin_cell[axis];
      if (cell_[axis] >= 0 && cell_[axis] < side) continue;
      const int step = ray_.step[axis];
      if (cell_[axis] < 0 ? step <= 0 : step >= 0) return false;
      const T time = plane_time(axis, step > 0 ? 0 : side);
      if (entry_axis < 0 || crosses_before(entry_time, entry_axis, time, axis)) {
        entry_time = time;
        entry_axis = axis;
      }
    }
    if (entry_axis < 0) return true;
    for (int axis = 0; axis < 3; ++axis) {
      const int step = ray_.step[axis];
      if (axis == entry_axis) {
        cell_[axis] = step > 0 ? 0 : side - 1;
      } else {
        // One cell past the root is far enough to see that the ray misses it.
        const int last = step > 0 ? side : -1;
        if (step > 0 ? cell_[axis] < last : cell_[axis] > last) {
          cell_[axis] = cell_when(axis, entry_time, entry_axis, cell_[axis], last);
        }
      }
    }
    return !outside();
  }

  VoxelFrame frame_;
  T voxel_size_;
  RayOf<T> ray_{};
  glm::ivec3 eye_{0}, cell_{0};  // relative to the root's corner
  Now now_ = Now::kOutside;
  int level_ = 1;    // of the node to look into: it spans 4^level cells
  int highest_ = 1;  // level of the nodes that are kept
  VoxelNode nodes_[kNodesOfRay];
};

}  // namespace sgs
