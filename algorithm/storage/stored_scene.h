// A scene as machines find it in memory, and beside the bytes what golden renderers need of it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "algorithm/memory/scene_layout.h"
#include "algorithm/memory/storage_config.h"
#include "algorithm/scene/camera.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/storage/image_file.h"
#include "algorithm/voxel/chunk_tree.h"
#include "algorithm/voxel/voxel_grid.h"
#include "algorithm/vq/quantise.h"

namespace sgs {

// Bands of spherical harmonics that a scene stores: all of them, or those that its colours need
// (storage.sh_tolerance).
struct ShBands {
  int degree = 0;         // degree that is stored
  double most_error = 0;  // most that the bands beyond it add to a channel of any colour
};

// The lowest degree whose colours, of every Gaussian that is stored and from every direction, are
// within config.sh_tolerance of the whole ones; the cloud's own where that is 0. By the addition
// theorem the squares of a band's basis functions sum to (2 l + 1) / (4 pi) in any direction, so
// that band l adds at most sqrt((2 l + 1) / (4 pi)) times the length of its coefficients. A pixel
// is a mean of colours and background, and no farther off than the worst of them; in exact
// arithmetic: beside this float rounds.
ShBands bands_to_store(const ActivatedCloud& cloud, const StorageConfig& config);

// The cloud without the bands beyond `degree`, at most its own.
ActivatedCloud with_bands(const ActivatedCloud& cloud, int degree);

// All Gaussians are read, in whatever sequence; no table finds them.
struct NoTable {};

// [StorageOrder]
using StoredTable = std::variant<VoxelGrid, ChunkTree, NoTable>;

// Its clouds are in storage order, a Gaussian's index its slot, and hold what is stored and no
// more: what is left out no view can show, in the one as in the other.
struct StoredScene {
  StorageConfig storage;  // nothing left to be chosen
  MemoryImage image;
  ActivatedCloud decoded;                  // the image's records as the units decode them
  StoredTable table;                       // table of `decoded`
  std::optional<ActivatedCloud> original;  // whole and not encoded; none where nothing was lost
  // [slot] index in the scene's file; none of a scene out of a packed file, which does not say.
  std::optional<std::vector<std::uint32_t>> file_indices;
  std::uint64_t gaussians = 0;  // in the scene, stored or not
  int sh_bands_left_out = 0;    // bands of the scene that storage.sh_tolerance spared
  double sh_error = 0;          // most that they add to a channel of a colour

  // True if `original`, or `decoded` in its stead, is what was stored. False for a scene restored
  // from a lossy encoding: what that cost cannot be told.
  bool original_known() const {
    return original.has_value() ||
           (storage.encoding == SecondHalfEncoding::kRaw && sh_bands_left_out == 0);
  }

  // For who reads scenes of this order alone; std::bad_variant_access in the others.
  const VoxelGrid& grid() const { return std::get<VoxelGrid>(table); }
  const ChunkTree& tree() const { return std::get<ChunkTree>(table); }
};

// Encodes, sorts and lays out a scene as a storage configuration says. weighing: cameras that weigh
// the Gaussians where codebooks are made; progress: of that. Throws InputError where a size is
// still to be chosen (storage_scheme.h), or voxels are too small for the scene.
StoredScene store_scene(ActivatedCloud cloud, const StorageConfig& config,
                        const std::vector<Camera>& weighing, const VqProgress& progress = {});

// The codebooks of a scene, and their indices: what store_scene makes for vq and vq_packed,
// whatever the order.
QuantisedCloud quantise_scene(const ActivatedCloud& cloud, const VqConfig& config,
                              const std::vector<Camera>& weighing, const VqProgress& progress = {});

// Stores a scene that was quantised elsewhere. quantised: of this cloud, with the bands that are
// stored (bands_to_store), whose centres, largest scales and order are stored as they are; config's
// encoding: vq or vq_packed.
StoredScene store_quantised(ActivatedCloud cloud, const QuantisedCloud& quantised,
                            const StorageConfig& config);

// The inverse of storing: from a memory image the scene that golden renderers need. These give the
// same bits on it as on the scene that was stored. source: what errors name. Throws InputError when
// tables or records say what no builder could have written.
StoredScene restore_scene(PackedScene packed, const std::string& source);

}  // namespace sgs
