// Chunks for exact order: Gaussians that lie together and are alike in size, and the tree that
// finds those that a pixel group needs. The tree decides where to cut: one top-down pass over
// centre and size takes the place of levels and cells, so that giants and outliers end in chunks of
// their own.
#pragma once

#include <cstdint>
#include <vector>

#include "algorithm/splat/gaussian.h"
#include "algorithm/voxel/chunk_node.h"
#include "algorithm/voxel/voxel_grid.h"

namespace sgs {

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
