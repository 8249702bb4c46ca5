// The bytes of an encoded scene that is in storage order.
#pragma once

#include <cstring>
#include <vector>

#include "algorithm/memory/scene_layout.h"
#include "algorithm/storage/encoded_cloud.h"
#include "algorithm/storage/stored_scene.h"
#include "algorithm/voxel/chunk_tree.h"
#include "algorithm/voxel/voxel_grid.h"

namespace sgs {

// The table is of scene.decoded: slots are its indices.
MemoryImage build_memory_image(const EncodedCloud& scene, const VoxelGrid& grid);
MemoryImage build_memory_image(const EncodedCloud& scene, const ChunkTree& tree);
MemoryImage build_memory_image(const EncodedCloud& scene, NoTable);

// The parts of an image: records and codebooks and, one by one, the order's own records.
MemoryImage store_gaussians(const EncodedCloud& scene, SceneLayout layout);

template <class Record>
void store_table(const std::vector<Record>& records, std::uint64_t address, MemoryImage& image) {
  if (records.empty()) return;
  std::memcpy(image.bytes.data() + address, records.data(), records.size() * sizeof(Record));
}

template <class Record>
std::uint32_t count_of(const std::vector<Record>& records) {
  return static_cast<std::uint32_t>(records.size());
}

}  // namespace sgs
