// The tables of a memory image read back, with nothing in them believed.
#pragma once

#include <string>

#include "algorithm/memory/memory_image.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/voxel/chunk_tree.h"
#include "algorithm/voxel/voxel_grid.h"

namespace sgs {

// decoded: the Gaussians by slot. source: what errors name. Both throw InputError for a table that
// no builder could have made.

// Every node and voxel is reached once, and
// every Gaussian lies in the cell of its voxel.
VoxelGrid read_voxel_table(const MemoryImage& image, const ActivatedCloud& decoded,
                           const std::string& source);

// Every node and slot is reached once, and every
// child's bound holds the Gaussians below it, so that exact order misses none.
ChunkTree read_chunk_table(const MemoryImage& image, std::uint32_t chunk_gaussians,
                           const ActivatedCloud& decoded, const std::string& source);

}  // namespace sgs
