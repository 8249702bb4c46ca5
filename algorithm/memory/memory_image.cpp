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

using RegionSizes = std::array<std::uint64_t, kRegionCount>;

void place_regions(const RegionSizes& sizes, MemoryLayout& layout) {
  std::uint64_t base = 0;
  for (std::size_t region = 0; region < kRegionCount; ++region) {
    layout.regions[region] = {base, sizes[region]};
    base = aligned(base + sizes[region]);
  }
}

template <class Record>
void copy_table(const std::vector<Record>& records, std::uint64_t address, MemoryImage& image) {
  if (records.empty()) return;
  std::memcpy(image.bytes.data() + address, records.data(), records.size() * sizeof(Record));
}

// What every order stores. `tables`: sizes of the order's own regions.
MemoryImage place_scene(const EncodedCloud& scene, std::size_t stored, RegionSizes tables) {
  MemoryImage image;
  MemoryLayout& layout = image.layout;
  layout.gaussian_count = static_cast<std::uint32_t>(stored);
  layout.second_half = scene.format;
  tables[region_id(Region::kFirstHalves)] = stored * kFirstHalfBytes;
  tables[region_id(Region::kSecondHalves)] = stored * layout.second_half_bytes();
  tables[region_id(Region::kCodebooks)] = scene.codebooks.size();
  place_regions(tables, layout);
  image.bytes.resize(layout[Region::kSpill].base);
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
  RegionSizes sizes{};
  sizes[region_id(Region::kVoxelTable)] =
      grid.nodes.size() * sizeof(VoxelNode) + grid.voxels.size() * sizeof(VoxelRecord);
  MemoryImage image = place_scene(scene, grid.storage_order.size(), sizes);
  MemoryLayout& layout = image.layout;
  layout.voxel_frame = grid.frame;
  layout.node_count = static_cast<std::uint32_t>(grid.nodes.size());
  layout.voxel_count = static_cast<std::uint32_t>(grid.voxels.size());
  copy_table(grid.nodes, layout.node_address(0), image);
  copy_table(grid.voxels, layout.voxel_address(0), image);
  store_gaussians(scene, grid.storage_order, image);
  return image;
}

MemoryImage build_memory_image(const EncodedCloud& scene, const ChunkTree& tree) {
  RegionSizes sizes{};
  sizes[region_id(Region::kChunkTable)] = tree.nodes.size() * sizeof(ChunkNode);
  sizes[region_id(Region::kIndices)] = tree.storage_order.size() * sizeof(std::uint32_t);
  MemoryImage image = place_scene(scene, tree.storage_order.size(), sizes);
  MemoryLayout& layout = image.layout;
  layout.storage_order = StorageOrder::kChunks;
  layout.chunk_node_count = static_cast<std::uint32_t>(tree.nodes.size());
  layout.chunk_count = tree.chunk_count;
  copy_table(tree.nodes, layout.chunk_node_address(0), image);
  copy_table(tree.storage_order, layout.index_address(0), image);
  store_gaussians(scene, tree.storage_order, image);
  return image;
}

MemoryLayout with_working_regions(MemoryLayout layout, std::uint64_t spill_bytes,
                                  std::uint64_t frame_bytes) {
  RegionSizes sizes;
  for (std::size_t region = 0; region < kRegionCount; ++region) {
    sizes[region] = layout.regions[region].bytes;
  }
  sizes[region_id(Region::kSpill)] = spill_bytes;
  sizes[region_id(Region::kFrameBuffer)] = frame_bytes;
  place_regions(sizes, layout);
  return layout;
}

}  // namespace sgs
