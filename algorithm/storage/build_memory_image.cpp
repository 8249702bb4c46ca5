// Filling of the memory image.
#include "algorithm/storage/build_memory_image.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cstring>
#include <utility>

namespace sgs {
namespace {

template <class Record>
void copy_table(const std::vector<Record>& records, std::uint64_t address, MemoryImage& image) {
  if (records.empty()) return;
  std::memcpy(image.bytes.data() + address, records.data(), records.size() * sizeof(Record));
}

// The records and codebooks; the order's own table is still empty.
MemoryImage store_gaussians(const EncodedCloud& scene, SceneLayout layout,
                            const std::vector<std::uint32_t>& storage_order) {
  MemoryImage image{std::move(layout), {}};
  image.bytes.resize(image.layout.stored_bytes);
  const RecordArray &first_halves = image.layout.first_halves,
                    &second_halves = image.layout.second_halves;
  copy_table(scene.codebooks, image.layout.codebooks.base, image);
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, storage_order.size(), 4096), [&](const auto& range) {
        for (std::size_t slot = range.begin(); slot != range.end(); ++slot) {
          const std::uint32_t index = storage_order[slot];
          encode_first_half(scene.decoded.gaussians[index],
                            image.bytes.data() + first_halves.address(slot));
          scene.write_second_half(index, image.bytes.data() + second_halves.address(slot));
        }
      });
  return image;
}

template <class Table>
std::uint32_t count_of(const std::vector<Table>& table) {
  return static_cast<std::uint32_t>(table.size());
}

}  // namespace

MemoryImage build_memory_image(const EncodedCloud& scene, const VoxelGrid& grid) {
  MemoryImage image =
      store_gaussians(scene,
                      lay_out_voxels(scene.format, count_of(grid.storage_order), grid.frame,
                                     count_of(grid.nodes), count_of(grid.voxels)),
                      grid.storage_order);
  const VoxelTableLayout& table = image.layout.voxel_table();
  copy_table(grid.nodes, table.nodes.base, image);
  copy_table(grid.voxels, table.voxels.base, image);
  return image;
}

MemoryImage build_memory_image(const EncodedCloud& scene, const ChunkTree& tree) {
  MemoryImage image = store_gaussians(scene,
                                      lay_out_chunks(scene.format, count_of(tree.storage_order),
                                                     count_of(tree.nodes), tree.chunk_count),
                                      tree.storage_order);
  const ChunkTableLayout& table = image.layout.chunk_table();
  copy_table(tree.nodes, table.nodes.base, image);
  copy_table(tree.storage_order, table.indices.base, image);
  return image;
}

}  // namespace sgs
