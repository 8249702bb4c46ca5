// A scene as the accelerator stores it, and beside the bytes what golden renderers need of it.
#pragma once

#include <cstdint>

#include "algorithm/memory/memory_image.h"

namespace sgs {

struct StoredScene {
  MemoryImage image;
  ActivatedCloud decoded;       // what the units get out of the image's records
  VoxelGrid grid;               // of `decoded`, where the image is laid out by voxels
  ChunkTree tree;               // of `decoded`, where it is laid out by chunks
  std::uint64_t gaussians = 0;  // in the scene, stored or not
};

StoredScene store_by_voxels(EncodedCloud scene, float voxel_size, Stored stored);
StoredScene store_by_chunks(EncodedCloud scene, std::uint32_t chunk_gaussians, Stored stored);

}  // namespace sgs
