// Traversal of the occupied voxels along a ray: Amanatides and Woo, "A Fast Voxel Traversal
// Algorithm for Ray Tracing" (1987), with empty blocks of the sparse tree crossed in one step, of
// 1, 2 or 4 children a side.
// Gives the very sequence of cells that stepping cell by cell through the dense grid would.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>

#include "algorithm/voxel/ray.h"
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

  using Index = IndexOf<T>;

  VoxelNode& node_at(int level) { return nodes_[level % kNodesOfRay]; }
  glm::ivec3 cell() const { return {value_of(cell_[0]), value_of(cell_[1]), value_of(cell_[2])}; }

  // Place of the cell among the children of the node.
  glm::uvec3 place() const {
    return glm::uvec3(cell()) >> static_cast<unsigned>(2 * (level_ - 1)) & 3U;
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
    return {RayEvent::kVoxel, child, cells_from_eye(eye_, cell())};
  }

  // Out of the largest block in which nothing is ahead.
  RayEventOf step() {
    const glm::ivec3 from = cell();
    const int log2_size = empty_block(node_at(level_), place(), ray_.step, level_);
    leave_block(log2_size);
    now_ = outside() ? Now::kOutside : Now::kInNode;
    if (now_ == Now::kInNode) {
      // Climb to the smallest node that holds the old cell and the new one.
      const glm::ivec3 to = cell();
      const auto differs =
          static_cast<unsigned>((from.x ^ to.x) | (from.y ^ to.y) | (from.z ^ to.z));
      while (differs >> (2 * level_) != 0) ++level_;
      if (level_ > highest_) now_ = Now::kAtRoot;
    }
    return {RayEvent::kStep, static_cast<std::uint32_t>(log2_size)};
  }

  bool outside() const {
    const auto side = static_cast<unsigned>(frame_.side_cells());
    const glm::uvec3 at(cell());
    return at.x >= side || at.y >= side || at.z >= side;
  }

  // Time at which the ray crosses the plane that lies `above` cells over the one below `cell`
  // (relative to the root) of an axis.
  T plane_time(int axis, Index cell, int above) const {
    return ray_.plane_time(axis, cell + (frame_.origin_cell[axis] + above), voxel_size_);
  }

  // Cell along `axis` when the ray crosses another axis' plane at `time`, between `from` and `last`
  // (in the direction of travel): all planes crossed before count. Where the ray is at that time
  // only says where to look: the planes' own times decide, so that the cell does not depend on how
  // the position is rounded.
  Index cell_when(int axis, T time, int crossed_axis, Index from, Index last) const {
    const int step = ray_.step[axis];
    if (step == 0 || value_of(from) == value_of(last)) return from;
    using std::floor;
    const T position = (ray_.origin[axis] + time * ray_.direction[axis]) / voxel_size_;
    const T relative = floor(position) - T(static_cast<float>(frame_.origin_cell[axis]));
    const T first = number_of<T>(step > 0 ? from : last),
            end = number_of<T>(step > 0 ? last : from);
    Index cell = static_cast<Index>(clamp_of(relative, first, end));
    const int far_side = step > 0 ? 1 : 0;  // plane by which a cell is left
    const auto left_before = [&](Index c, int steps_ago) {
      return crosses_before(plane_time(axis, c, far_side - steps_ago * step), axis, time,
                            crossed_axis);
    };
    while (value_of(cell) != value_of(last) && left_before(cell, 0)) cell = cell + step;
    while (value_of(cell) != value_of(from) && !left_before(cell, 1)) cell = cell + -step;
    return cell;
  }

  // Moves to the first cell beyond the block of 2^log2_size cells a side that holds the current
  // one.
  void leave_block(int log2_size) {
    const int size = 1 << log2_size;
    int exit_axis = 0;
    T exit_time{};
    Index last[3];
    for (int axis = 0; axis < 3; ++axis) {
      const Index low = without_bits(cell_[axis], size - 1);
      last[axis] = ray_.step[axis] > 0 ? with_bits(cell_[axis], size - 1) : low;
      const T time = plane_time(axis, low, ray_.step[axis] > 0 ? size : 0);
      if (axis > 0 && time < exit_time) exit_axis = axis;
      exit_time = axis == 0 ? time : min_of(exit_time, time);
    }
    if (ray_.step[exit_axis] == 0) {  // a direction of zero length never leaves
      cell_[0] = -1;
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
      cell_[axis] = cell_of(ray_.origin[axis], voxel_size_) + -frame_.origin_cell[axis];
      const int at = value_of(cell_[axis]), step = ray_.step[axis];
      if (at >= 0 && at < side) continue;
      if (at < 0 ? step <= 0 : step >= 0) return false;
      const T time = plane_time(axis, Index(step > 0 ? 0 : side), 0);
      const bool first = entry_axis < 0;
      // The last crossing is the one that enters; of equal times that of the later axis.
      if (first || entry_time <= time) entry_axis = axis;
      entry_time = first ? time : max_of(entry_time, time);
    }
    if (entry_axis < 0) return true;
    for (int axis = 0; axis < 3; ++axis) {
      const int step = ray_.step[axis];
      if (axis == entry_axis) {
        cell_[axis] = step > 0 ? 0 : side - 1;
      } else {
        // One cell past the root is far enough to see that the ray misses it.
        const int last = step > 0 ? side : -1, at = value_of(cell_[axis]);
        if (step > 0 ? at < last : at > last) {
          cell_[axis] = cell_when(axis, entry_time, entry_axis, cell_[axis], last);
        }
      }
    }
    return !outside();
  }

  VoxelFrame frame_;
  T voxel_size_;
  RayOf<T> ray_{};
  glm::ivec3 eye_{0};   // its cell, relative to the root's corner
  Index cell_[3] = {};  // likewise
  Now now_ = Now::kOutside;
  int level_ = 1;    // level of the node to look into: it spans 4^level cells
  int highest_ = 1;  // level of the nodes that are kept
  VoxelNode nodes_[kNodesOfRay];
};

}  // namespace sgs
