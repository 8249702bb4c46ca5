// The binary tree that the chunk tree is built as, before its nodes are made wide: a leaf is a
// chunk.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "algorithm/voxel/chunk_node.h"

namespace sgs {

struct BinaryNode {
  ChunkBound bound;
  std::uint32_t begin = 0, end = 0;  // items
  std::unique_ptr<BinaryNode> left, right;
  // [k - 1] least cost of the wide nodes below, when what is below becomes at most k children of a
  // wide node above (wide_nodes.h).
  std::array<double, kChunkNodeWidth - 1> cost_as{};
  bool leaf() const { return left == nullptr; }
};

// Half the surface of the box of the centres, grown by the extents to all sides: what decides how
// often it is met.
float inflated_area(const ChunkBound& bound);

}  // namespace sgs
