// Clouds in storage order, each with the table that finds its Gaussians.
#pragma once

#include <cstdint>
#include <utility>

#include "algorithm/splat/gaussian.h"
#include "algorithm/voxel/chunk_tree.h"
#include "algorithm/voxel/voxel_grid.h"

namespace sgs::test {

template <class Table>
struct StoredCloud {
  ActivatedCloud cloud;
  Table table;
};

inline StoredCloud<ChunkTree> by_chunks(const ActivatedCloud& cloud, std::uint32_t chunk_gaussians,
                                        Stored stored = Stored::kVisible) {
  auto [tree, order] = arrange_by_chunks(cloud, chunk_gaussians, stored);
  return {reordered(cloud, order), std::move(tree)};
}

inline StoredCloud<VoxelGrid> by_voxels(const ActivatedCloud& cloud, float voxel_size,
                                        Stored stored = Stored::kVisible) {
  auto [grid, order] = arrange_by_voxels(cloud, voxel_size, stored);
  return {reordered(cloud, order), std::move(grid)};
}

}  // namespace sgs::test
