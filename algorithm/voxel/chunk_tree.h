// Chunks for exact order: Gaussians that lie together and are alike in size, and the tree that
// finds those that a pixel group needs. The tree decides where to cut: one top-down pass over
// centre and size takes the place of levels and cells, so that giants and outliers end in chunks of
// their own.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <vector>

#include "algorithm/splat/gaussian.h"
#include "algorithm/splat/scalar.h"
#include "algorithm/voxel/voxel_grid.h"

namespace sgs {

constexpr int kChunkNodeWidth = 8;

// Bounds of all Gaussians below a child, known without looking at them. World frame.
template <class T>
struct ChunkBoundOf {
  glm::vec<3, T> low{T(0.0F)}, high{T(0.0F)};  // box of the centres
  glm::vec<3, T> extent{T(0.0F)};              // largest visible half-extent along each axis
  T scale_max = T(0.0F);                       // largest scale
};
using ChunkBound = ChunkBoundOf<float>;

// The bound of two sets of Gaussians together.
ChunkBound merged(const ChunkBound& a, const ChunkBound& b);

// 128 B, four bursts. A child is a chunk of `count` Gaussians or, with count 0, an inner node. The
// chunks of a node lie in consecutive storage slots from first_slot, its inner children in
// consecutive nodes from first_node, both in the order of the children.
struct ChunkNode {
  float origin[3] = {};
  std::int8_t step_exponent[3] = {};  // box bounds are origin + q 2^exponent
  std::int8_t extent_exponent = 0;    // extents are 2^(exponent - (255 - q) / 16)
  std::uint32_t first_slot = 0, first_node = 0;
  std::uint8_t low[kChunkNodeWidth][3] = {}, high[kChunkNodeWidth][3] = {};
  std::uint8_t extent[kChunkNodeWidth][3] = {}, scale[kChunkNodeWidth] = {};
  std::uint16_t count[kChunkNodeWidth] = {};
  std::uint8_t children = 0;
  std::uint8_t reserved[7] = {};
};
static_assert(sizeof(ChunkNode) == 128);

// Quantises the bounds of a node's children, never inward. Needs node.children and counts set.
void quantise(const ChunkBound* bounds, ChunkNode& node);

// The bound of one child, never smaller than what was quantised. Extents beyond the range come back
// as infinity.
ChunkBound child_bound(const ChunkNode& node, int child);

// Decoding of a child's quantised bounds, for any scalar.
constexpr int kExtentSteps = 16;  // steps in an octave
constexpr int kMostExtent = 255;

// 2^(-(15 - q mod 16) / 16), rounded up, so that no extent comes back smaller.
float extent_fraction(int q);

// x 2^exponent: an addition to its exponent.
inline float scaled_by_exponent(float x, int exponent) { return std::ldexp(x, exponent); }

// origin + q step.
template <class T>
T box_bound(T origin, T step, IndexOf<T> q) {
  return T(origin + number_of<T>(q) * step);
}

// 2^(exponent - (255 - q) / 16), where exponent is least + 15.
template <class T>
T extent_value(IndexOf<T> q, IndexOf<T> least) {
  return scaled_by_exponent(extent_fraction(q), least + q / kExtentSteps);
}
inline int least_extent_exponent(int exponent) { return exponent - kMostExtent / kExtentSteps; }

struct ChunkTree {
  std::vector<ChunkNode> nodes;  // breadth first: root at 0; empty for an empty cloud
  std::uint32_t chunk_count = 0;
  std::uint32_t depth = 0;  // levels of nodes
};

// Storage order: by chunk, then index. chunk_gaussians: most Gaussians in a chunk, 1 to 65535.
// Deterministic whatever the number of threads. Splits minimise the surface area heuristic over
// boxes inflated by the visible extents: the area is what decides how many pixel groups a chunk
// meets.
Arrangement<ChunkTree> arrange_by_chunks(const ActivatedCloud& cloud, std::uint32_t chunk_gaussians,
                                         Stored stored = Stored::kVisible);

// Bound of one Gaussian: its centre and its visible extents.
ChunkBound gaussian_bound(const Gaussian<float>& g);

}  // namespace sgs
