// Keys of storage.
#include "modules/storage_keys.h"

namespace sgs {

void visit(ConfigVisitor& v, VqConfig& c) {
  const ConfigRange entries = in_range(1, kMaxCodebookEntries);
  v("scale_entries", c.scale_entries, entries, "most entries of the scale codebook");
  v("rotation_entries", c.rotation_entries, entries, "of the rotation codebook");
  v("dc_entries", c.dc_entries, entries, "of the codebook of base colours");
  v("sh_entries", c.sh_entries, entries, "of the codebook of the higher bands");
  v("iterations", c.iterations, in_range(0, 1000), "of k-means, at most");
  v("seed", c.seed, at_least(0), "of k-means");
}

void visit(ConfigVisitor& v, StorageConfig& c) {
  if (c.order == StorageOrder::kVoxels) {
    v("voxel_size", c.voxel_size, in_range(0, 1e9),
      "world units; 0: 0.4 for a scene below 10 units across, else 2");
  } else {
    v("chunk_gaussians", c.chunk_gaussians, in_range(0, 65535),
      "most Gaussians in a chunk; 0: as many as lie together in a DRAM row");
  }
  v("encoding", c.encoding,
    names<SecondHalfEncoding>({{"raw", SecondHalfEncoding::kRaw},
                               {"half", SecondHalfEncoding::kHalf},
                               {"vq", SecondHalfEncoding::kVq},
                               {"vq_packed", SecondHalfEncoding::kVqPacked}}),
    "of second halves: 32-bit floats, 16-bit floats, codebook indices of 32 bits or packed");
  v.section("vq", c.vq, "how codebooks are made");
  v("store_invisible", c.store_invisible, "also store Gaussians with opacity below 1/255");
}

}  // namespace sgs
