// The bytes of an encoded scene in one of the storage orders.
#pragma once

#include "algorithm/memory/memory_image.h"
#include "algorithm/storage/encoded_cloud.h"
#include "algorithm/voxel/chunk_tree.h"
#include "algorithm/voxel/voxel_grid.h"

namespace sgs {

// The grid or tree is of scene.decoded.
MemoryImage build_memory_image(const EncodedCloud& scene, const VoxelGrid& grid);
MemoryImage build_memory_image(const EncodedCloud& scene, const ChunkTree& tree);

}  // namespace sgs
