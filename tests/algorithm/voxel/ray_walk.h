// Rays through a tree, each followed to its end, without any time.
#pragma once

#include <cstdint>
#include <utility>

#include "algorithm/voxel/ray.h"
#include "algorithm/voxel/voxel_grid.h"

namespace sgs {

// Path: RayPath or SamplePath. Table: anything with `VoxelNode node(std::uint32_t index)`.
template <class Path, class Table>
class RayWalk {
 public:
  RayWalk(Path path, Table& table) : path_(std::move(path)), table_(table) {}

  // Calls visit(voxel, cells_from_eye()) for each occupied voxel that the ray meets, nearest first,
  // until it returns false. Returns the number of steps: into the tree, and those along the ray.
  template <class Visit>
  std::uint32_t walk(const Ray& ray, Visit&& visit) {
    path_.begin(ray);
    std::uint32_t steps = 1;
    while (true) {
      const RayEventOf event = path_.next();
      switch (event.what) {
        case RayEvent::kLookUp:
          path_.give(table_.node(event.index));
          break;
        case RayEvent::kVoxel:
          if (!visit(event.index, event.cells)) return steps;
          break;
        case RayEvent::kStep:
          ++steps;
          break;
        case RayEvent::kEnd:
          return steps;
      }
    }
  }

 private:
  Path path_;
  Table& table_;
};

}  // namespace sgs
