// What a ray does next on its way through the voxel tree: so that whoever follows it, at once or
// beside other rays and with time passing, follows it in the same way.
#pragma once

#include <cstdint>

namespace sgs {

enum class RayEvent : std::uint8_t {
  kLookUp,  // it wants the node `index`, and goes on when it is given
  kVoxel,   // it meets the voxel `index`
  kStep,    // it has left a block, or taken a sample
  kEnd      // it has left the tree, or never enters it
};

// The numbers that belong to an event: a node's or a voxel's, and of a voxel cells_from_eye(); of a
// step log2 of the cells a side of the block that was left, 0 of a sample.
struct RayEventOf {
  RayEvent what = RayEvent::kEnd;
  std::uint32_t index = 0;
  std::uint32_t cells = 0;
};

// Follows a ray to its end, without any time. Path: RayPath or SamplePath. Table: anything with
// `VoxelNode node(std::uint32_t index)`. Calls visit(voxel, cells_from_eye()) for each occupied
// voxel that the ray meets, nearest first, until it returns false. Returns the number of steps
// taken: into the tree, and those along it.
template <class Path, class Ray, class Table, class Visit>
std::uint32_t follow(Path& path, const Ray& ray, Table& table, Visit&& visit) {
  path.begin(ray);
  std::uint32_t steps = 1;
  while (true) {
    const RayEventOf event = path.next();
    switch (event.what) {
      case RayEvent::kLookUp:
        path.give(table.node(event.index));
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

}  // namespace sgs
