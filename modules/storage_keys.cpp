// Keys of storage.
#include "modules/storage_keys.h"

#include "algorithm/storage/storage_scheme.h"

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
  for (const StorageSize& size : scheme_of(c.order).sizes()) {
    std::visit([&](auto value) { v(size.key, c.*value, in_range(0, size.most), size.meaning); },
               size.value);
  }
  if (scheme_of(c.order).has_sequence()) {
    v("sequence", c.sequence,
      names<FileSequence>({{"file", FileSequence::kFile}, {"spatial", FileSequence::kSpatial}}),
      "of Gaussians: as in the scene's file, or neighbours in space side by side");
  }
  v("encoding", c.encoding,
    names<SecondHalfEncoding>({{"raw", SecondHalfEncoding::kRaw},
                               {"half", SecondHalfEncoding::kHalf},
                               {"vq", SecondHalfEncoding::kVq},
                               {"vq_packed", SecondHalfEncoding::kVqPacked}}),
    "of second halves: 32-bit floats, 16-bit floats, codebook indices of 32 bits or packed");
  v.section("vq", c.vq, "how codebooks are made");
  v("store_invisible", c.store_invisible, "also store Gaussians with opacity below 1/255");
  v("sh_tolerance", c.sh_tolerance, in_range(0, 1),
    "most that a channel of a colour may change by SH bands that are not stored; 0: all are");
}

}  // namespace sgs
