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
  std::vector<std::uint32_t>
      storage_order;  // [stored] file index of each slot: by chunk, then index
  std::uint32_t chunk_count = 0;
  std::uint32_t depth = 0;  // levels of nodes
};

// chunk_gaussians: most Gaussians in a chunk, 1 to 65535. Deterministic whatever the number of
// threads. Splits minimise the surface area heuristic over boxes inflated by the visible extents:
// the area is what decides how many pixel groups a chunk meets.
ChunkTree build_chunk_tree(const ActivatedCloud& cloud, std::uint32_t chunk_gaussians,
                           Stored stored = Stored::kVisible);

// Bound of one Gaussian: its centre, k sqrt(Sigma_aa) with k = sqrt(2 ln(255 opacity)), its largest
// scale; rounded up.
ChunkBound gaussian_bound(const Gaussian<float>& g);

}  // namespace sgs
