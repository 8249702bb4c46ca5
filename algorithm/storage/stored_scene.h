// A scene as machines find it in memory, and beside the bytes what golden renderers need of it.
#pragma once

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "algorithm/memory/memory_image.h"
#include "algorithm/memory/storage_config.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/voxel/chunk_tree.h"
#include "algorithm/voxel/voxel_grid.h"

namespace sgs {

// All Gaussians are read, in whatever sequence; no table finds them.
struct NoTable {};

// [StorageOrder]
using StoredTable = std::variant<VoxelGrid, ChunkTree, NoTable>;

// Its clouds are in storage order, a Gaussian's index its slot, and hold what is stored and no
// more: what is left out no view can show, in the one as in the other.
struct StoredScene {
  StorageConfig storage;  // nothing left to be chosen
  MemoryImage image;
  ActivatedCloud decoded;                  // what the units get out of the image's records
  StoredTable table;                       // of `decoded`
  std::optional<ActivatedCloud> original;  // whole and not encoded; none where nothing was lost
  // [slot] index in the scene's file; none of a scene out of a packed file, which does not say.
  std::optional<std::vector<std::uint32_t>> file_indices;
  std::uint64_t gaussians = 0;  // in the scene, stored or not
  int sh_bands_left_out = 0;    // of the scene's, that storage.sh_tolerance spared
  double sh_error = 0;          // most that they add to a channel of a colour

  // Whether `original`, or `decoded` in its stead, is what was stored. Not of a scene restored from
  // a lossy encoding: what that cost cannot be told.
  bool original_known() const {
    return original.has_value() ||
           (storage.encoding == SecondHalfEncoding::kRaw && sh_bands_left_out == 0);
  }

  // For who reads scenes of this order alone; std::bad_variant_access in the others.
  const VoxelGrid& grid() const { return std::get<VoxelGrid>(table); }
  const ChunkTree& tree() const { return std::get<ChunkTree>(table); }
};

}  // namespace sgs
