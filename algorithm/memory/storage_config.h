// How a scene is stored: a property of the bytes in memory, whatever machine reads them.
#pragma once

#include <cstdint>

#include "algorithm/memory/scene_layout.h"
#include "algorithm/memory/second_half.h"

namespace sgs {

// The sequence of a scene without a table, whose machine finds by itself what it needs: that of the
// scene's file, or neighbours in space side by side.
enum class FileSequence : std::uint8_t { kFile, kSpatial };

// What a voxel size that is left open is taken from: the scene's extent, or the paper's two sizes
// for scenes whose unit of length is the paper's.
enum class VoxelRule : std::uint8_t { kExtent, kReal, kSynthetic };

struct StorageConfig {
  StorageOrder order = StorageOrder::kChunks;
  // Keys of one order, which its scheme says (../storage/storage_scheme.h).
  double voxel_size = 0;
  VoxelRule voxel_rule = VoxelRule::kExtent;
  std::uint32_t chunk_gaussians = 8;
  FileSequence sequence = FileSequence::kSpatial;
  // Keys of every order.
  SecondHalfEncoding encoding = SecondHalfEncoding::kRaw;
  VqConfig vq;
  bool store_invisible = false;
  double sh_tolerance = 0;

  // The format of second halves with every codebook as large as it may become.
  SecondHalfFormat widest_format(int sh_degree) const {
    SecondHalfFormat format{encoding, sh_degree, {}};
    if (!format.quantised()) return format;
    for (std::size_t id = 0; id < kCodebookCount; ++id) {
      const auto codebook = static_cast<Codebook>(id);
      format.entries[id] = codebook_words(codebook, sh_degree) > 0 ? vq.entries(codebook) : 0;
    }
    return format;
  }
};

// The keys of every order, for a visitor as modules/config has.
template <class Visitor>
void visit_every_order(Visitor& v, StorageConfig& c) {
  v("encoding", c.encoding,
    {{"raw", SecondHalfEncoding::kRaw},
     {"half", SecondHalfEncoding::kHalf},
     {"vq", SecondHalfEncoding::kVq},
     {"vq_packed", SecondHalfEncoding::kVqPacked}},
    "of second halves: 32-bit floats, 16-bit floats, codebook indices of 32 bits or packed");
  v.section("vq", c.vq, "how codebooks are made");
  v("store_invisible", c.store_invisible, "also store Gaussians with opacity below 1/255");
  v("sh_tolerance", c.sh_tolerance, {0, 1},
    "most that a channel of a colour may change by SH bands that are not stored; 0: all are");
}

}  // namespace sgs
