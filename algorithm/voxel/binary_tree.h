// The binary tree that the chunk tree is built as: how items are cut in two, and which nodes become
// one wide node.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "algorithm/splat/gaussian.h"
#include "algorithm/voxel/chunk_tree.h"

namespace sgs {

// A node with the bound of its items; a leaf is a chunk.
struct BinaryNode {
  ChunkBound bound;
  std::uint32_t begin = 0, end = 0;  // items
  std::unique_ptr<BinaryNode> left, right;
  // [k - 1] least cost of the wide nodes below, when what is below becomes at most k children of a
  // wide node above (note_costs).
  std::array<double, kChunkNodeWidth - 1> cost_as{};
  bool leaf() const { return left == nullptr; }
};

// Half the surface of the box of the centres, grown by the extents to all sides: it decides how
// often the box is met.
float inflated_area(const ChunkBound& bound);

// A set of Gaussians is cut in two on the way down to chunks, by binned costs along four axes
// (Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies", 2007).

// A Gaussian as it is sorted into chunks.
struct ChunkItem {
  float at[4];     // x, y, z; log2 of the largest visible half-extent
  float reach[4];  // visible half-extents along x, y, z; largest scale
  std::uint32_t index;
};

ChunkItem chunk_item(const Gaussian<float>& g, std::uint32_t index);

// The bound of `count` items, one or more.
ChunkBound bound_of(const ChunkItem* items, std::uint32_t count);

// Reorders items, more of them than a chunk takes, into two parts of least cost and returns how
// many the first has: whole chunks. Independent of the order that they came in.
std::uint32_t cut_in_two(ChunkItem* items, std::uint32_t count, std::uint32_t chunk_gaussians);

// Up to eight descendants of a binary node become the children of a wide one: those with which all
// wide nodes of the tree together have the least inflated area, by dynamic programming (Ylitie,
// Karras and Laine 2017, section 4, without leaves of several primitives: chunks stay as they are).
// A node that is full costs what one with two children does: opening the largest child until there
// are eight leaves 4.5 children in a node, this 6.1.

// Fills node.cost_as from that of its children.
void note_costs(BinaryNode& node);

// Children of the wide node that stands for `node` and all below, in the order of the binary tree:
// `node` itself where it is a leaf. Needs the costs of all nodes below.
std::vector<const BinaryNode*> wide_children(const BinaryNode& node);

}  // namespace sgs
