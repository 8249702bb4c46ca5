// A chunk tree as the source of a walk (chunk_walk.h) that takes no time and reads no DRAM.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "algorithm/order/chunk_walk.h"
#include "algorithm/voxel/chunk_tree.h"

namespace sgs {

struct TreeInMemory {
  const ChunkTree& tree;
  std::vector<WalkEntry> aside;

  const ChunkNode& node(std::uint32_t index) const { return tree.nodes[index]; }
  void put_aside(const WalkEntry& entry) { aside.push_back(entry); }
  template <class To>
  void take_back(const To& to) {
    for (const WalkEntry& entry : std::exchange(aside, {})) to(entry);
  }
  void forget_aside() { aside.clear(); }
};

}  // namespace sgs
