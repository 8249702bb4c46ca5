// The tables of a memory image read back, with nothing in them believed.
#pragma once

#include <string>
#include <vector>

#include "algorithm/memory/memory_image.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/voxel/chunk_tree.h"
#include "algorithm/voxel/voxel_grid.h"

namespace sgs {

// source: what errors name. All throw InputError for a table that no builder could have made.

// decoded: the Gaussians in the order of their slots. Every node and voxel is reached once, and
// every Gaussian lies in the cell of its voxel.
VoxelGrid read_voxel_table(const MemoryImage& image, const ActivatedCloud& decoded,
                           const std::string& source);

// By chunks: of each slot its place among the stored Gaussians in the order of the scene's file,
// which had so many Gaussians.
std::vector<std::uint32_t> read_file_ranks(const MemoryImage& image, std::uint64_t gaussians,
                                           const std::string& source);

// storage_order: index in `decoded` of each slot. Every node and slot is reached once, and every
// child's bound holds the Gaussians below it, so that exact order misses none.
ChunkTree read_chunk_table(const MemoryImage& image, std::uint32_t chunk_gaussians,
                           std::vector<std::uint32_t> storage_order, const ActivatedCloud& decoded,
                           const std::string& source);

}  // namespace sgs
