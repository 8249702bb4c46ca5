// How a scene is stored: a property of the bytes in memory, whatever machine reads them.
#pragma once

#include <cstdint>

#include "algorithm/memory/codebook.h"
#include "algorithm/memory/scene_layout.h"
#include "algorithm/memory/second_half.h"

namespace sgs {

// The sequence of a scene without a table, whose machine finds by itself what it needs: that of the
// scene's file, or neighbours in space side by side.
enum class FileSequence : std::uint8_t { kFile, kSpatial };

struct StorageConfig {
  StorageOrder order = StorageOrder::kChunks;
  SecondHalfEncoding encoding = SecondHalfEncoding::kRaw;
  double voxel_size = 0;              // by voxels: world units; 0: to be chosen
  std::uint32_t chunk_gaussians = 8;  // by chunks: most Gaussians in one; 0: to be chosen
  FileSequence sequence = FileSequence::kSpatial;  // by file
  bool store_invisible = false;                    // also Gaussians that no view can show
  double sh_tolerance = 0;  // most that a colour may change by SH bands that are not stored
  VqConfig vq;              // how codebooks are made, where the encoding has any

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

}  // namespace sgs
