// A scene as machines find it in memory, and beside the bytes what golden renderers need of it.
#pragma once

#include <cstdint>
#include <optional>
#include <variant>

#include "algorithm/memory/memory_image.h"
#include "algorithm/memory/storage_config.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/storage/file_order.h"
#include "algorithm/voxel/chunk_tree.h"
#include "algorithm/voxel/voxel_grid.h"

namespace sgs {

struct StoredScene {
  StorageConfig storage;  // nothing left to be chosen
  MemoryImage image;
  ActivatedCloud decoded;  // what the units get out of the image's records
  std::variant<VoxelGrid, ChunkTree, FileOrder> table;  // of `decoded`, by the storage order
  std::optional<ActivatedCloud> original;  // that was encoded; none where nothing was lost
  std::uint64_t gaussians = 0;             // in the scene, stored or not

  // Whether `original`, or `decoded` in its stead, is what was stored. Not of a scene restored from
  // a lossy encoding: what that cost cannot be told.
  bool original_known() const {
    return original.has_value() || storage.encoding == SecondHalfEncoding::kRaw;
  }

  // For who reads scenes of this order alone; std::bad_variant_access in the others.
  const VoxelGrid& grid() const { return std::get<VoxelGrid>(table); }
  const ChunkTree& tree() const { return std::get<ChunkTree>(table); }
};

}  // namespace sgs
