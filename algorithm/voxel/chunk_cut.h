// Where a set of Gaussians is cut in two on the way down to chunks: binned costs along four axes
// (Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies", 2007).
#pragma once

#include <cstdint>

#include "algorithm/splat/gaussian.h"
#include "algorithm/voxel/chunk_node.h"

namespace sgs {

// A Gaussian as it is sorted into chunks.
struct ChunkItem {
  float at[4];     // x, y, z; log2 of the largest visible half-extent
  float reach[4];  // visible half-extents along x, y, z; largest scale
  std::uint32_t index;
};

ChunkItem chunk_item(const Gaussian<float>& g, std::uint32_t index);

// Of one or more.
ChunkBound bound_of(const ChunkItem* items, std::uint32_t count);

// Reorders items, more of them than a chunk takes, into two parts of least cost and returns how
// many the first has: whole chunks. Independent of the order that they came in.
std::uint32_t cut_in_two(ChunkItem* items, std::uint32_t count, std::uint32_t chunk_gaussians);

}  // namespace sgs
