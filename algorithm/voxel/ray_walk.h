// The exact traversal (ray_path.h) of a tree, ray by ray, without any time.
#pragma once

#include <cstdint>

#include "algorithm/voxel/ray_event.h"
#include "algorithm/voxel/ray_path.h"

namespace sgs {

// Table: anything with `VoxelNode node(std::uint32_t index)`.
template <class Table, class T = float>
class RayWalk {
 public:
  RayWalk(const VoxelFrame& frame, Table& table) : RayWalk(frame, table, T(frame.voxel_size)) {}
  // voxel_size: the frame's, as a value of the datapath.
  RayWalk(const VoxelFrame& frame, Table& table, T voxel_size)
      : path_(frame, voxel_size), table_(table) {}

  // As follow().
  template <class Visit>
  std::uint32_t walk(const RayOf<T>& ray, Visit&& visit) {
    return follow(path_, ray, table_, visit);
  }

 private:
  RayPath<T> path_;
  Table& table_;
};

}  // namespace sgs
