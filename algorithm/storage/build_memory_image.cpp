// Filling of the memory image, whatever its order.
#include "algorithm/storage/build_memory_image.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <utility>

namespace sgs {

MemoryImage store_gaussians(const EncodedCloud& scene, SceneLayout layout) {
  MemoryImage image{std::move(layout), {}};
  image.bytes.resize(image.layout.stored_bytes);
  const RecordArray &first_halves = image.layout.first_halves,
                    &second_halves = image.layout.second_halves;
  store_table(scene.codebooks, image.layout.codebooks.base, image);
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, scene.decoded.size(), 4096), [&](const auto& range) {
        for (std::size_t slot = range.begin(); slot != range.end(); ++slot) {
          std::byte encoded[kMaxSecondHalfBytes];
          scene.write_second_half(slot, encoded);
          write_record(image.layout.split, image.layout.second_half, scene.decoded.gaussians[slot],
                       encoded, image.bytes.data() + first_halves.address(slot),
                       image.bytes.data() + second_halves.address(slot));
        }
      });
  return image;
}

}  // namespace sgs
