// Filling of the memory image.
#include "algorithm/memory/memory_image.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cstring>

namespace sgs {
namespace {

constexpr std::uint64_t kRegionAlignment = 4096;

std::uint64_t aligned(std::uint64_t bytes) {
  return (bytes + kRegionAlignment - 1) / kRegionAlignment * kRegionAlignment;
}

template <class Record>
void copy_table(const std::vector<Record>& records, std::uint64_t address, MemoryImage& image) {
  if (records.empty()) return;
  std::memcpy(image.bytes.data() + address, records.data(), records.size() * sizeof(Record));
}

// What every order stores. The counts of the order's own tables are in `layout`.
MemoryImage place_scene(const EncodedCloud& scene, std::size_t stored, MemoryLayout layout) {
  layout.gaussian_count = static_cast<std::uint32_t>(stored);
  layout.second_half = scene.format;
  place_regions(layout, 0, 0);
  MemoryImage image{layout, std::vector<std::byte>(layout[Region::kSpill].base)};
  copy_table(scene.codebooks, layout[Region::kCodebooks].base, image);
  return image;
}

void store_gaussians(const EncodedCloud& scene, const std::vector<std::uint32_t>& storage_order,
                     MemoryImage& image) {
  const MemoryLayout& layout = image.layout;
  tbb::parallel_for(
      tbb::blocked_range<std::uint32_t>(0, layout.gaussian_count, 4096), [&](const auto& range) {
        for (std::uint32_t slot = range.begin(); slot != range.end(); ++slot) {
          const std::uint32_t index = storage_order[slot];
          encode_first_half(scene.decoded.gaussians[index],
                            image.bytes.data() + layout.first_half_address(slot));
          scene.write_second_half(index, image.bytes.data() + layout.second_half_address(slot));
        }
      });
}

}  // namespace

MemoryImage build_memory_image(const EncodedCloud& scene, const VoxelGrid& grid) {
  MemoryLayout layout;
  layout.voxel_frame = grid.frame;
  layout.node_count = static_cast<std::uint32_t>(grid.nodes.size());
  layout.voxel_count = static_cast<std::uint32_t>(grid.voxels.size());
  MemoryImage image = place_scene(scene, grid.storage_order.size(), layout);
  copy_table(grid.nodes, image.layout.node_address(0), image);
  copy_table(grid.voxels, image.layout.voxel_address(0), image);
  store_gaussians(scene, grid.storage_order, image);
  return image;
}

MemoryImage build_memory_image(const EncodedCloud& scene, const ChunkTree& tree) {
  MemoryLayout layout;
  layout.storage_order = StorageOrder::kChunks;
  layout.chunk_node_count = static_cast<std::uint32_t>(tree.nodes.size());
  layout.chunk_count = tree.chunk_count;
  MemoryImage image = place_scene(scene, tree.storage_order.size(), layout);
  copy_table(tree.nodes, image.layout.chunk_node_address(0), image);
  copy_table(tree.storage_order, image.layout.index_address(0), image);
  store_gaussians(scene, tree.storage_order, image);
  return image;
}

void place_regions(MemoryLayout& layout, std::uint64_t spill_bytes, std::uint64_t frame_bytes) {
  const std::uint64_t stored = layout.gaussian_count;
  const bool by_chunks = layout.storage_order == StorageOrder::kChunks;
  std::array<std::uint64_t, kRegionCount> sizes{};
  sizes[region_id(Region::kVoxelTable)] = std::uint64_t{layout.node_count} * sizeof(VoxelNode) +
                                          std::uint64_t{layout.voxel_count} * sizeof(VoxelRecord);
  sizes[region_id(Region::kFirstHalves)] = stored * kFirstHalfBytes;
  sizes[region_id(Region::kSecondHalves)] = stored * layout.second_half_bytes();
  sizes[region_id(Region::kCodebooks)] = layout.second_half.codebook_bytes();
  sizes[region_id(Region::kChunkTable)] =
      std::uint64_t{layout.chunk_node_count} * sizeof(ChunkNode);
  sizes[region_id(Region::kIndices)] = by_chunks ? stored * sizeof(std::uint32_t) : 0;
  sizes[region_id(Region::kSpill)] = spill_bytes;
  sizes[region_id(Region::kFrameBuffer)] = frame_bytes;
  std::uint64_t base = 0;
  for (std::size_t region = 0; region < kRegionCount; ++region) {
    layout.regions[region] = {base, sizes[region]};
    base = aligned(base + sizes[region]);
  }
}

MemoryLayout with_working_regions(MemoryLayout layout, std::uint64_t spill_bytes,
                                  std::uint64_t frame_bytes) {
  place_regions(layout, spill_bytes, frame_bytes);
  return layout;
}

}  // namespace sgs
