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

// Sizes of what every order stores.
RegionSizes common_sizes(const ActivatedCloud& cloud, std::size_t stored, std::uint64_t spill_bytes,
                         std::uint64_t frame_bytes) {
  RegionSizes sizes{};
  sizes[region_id(Region::kFirstHalves)] = stored * kFirstHalfBytes;
  sizes[region_id(Region::kSecondHalves)] = stored * raw_second_half_bytes(cloud.sh_degree);
  sizes[region_id(Region::kSpill)] = spill_bytes;
  sizes[region_id(Region::kFrameBuffer)] = frame_bytes;
  return sizes;
}

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

void store_gaussians(const ActivatedCloud& cloud, const std::vector<std::uint32_t>& storage_order,
                     MemoryImage& image) {
  const MemoryLayout& layout = image.layout;
  tbb::parallel_for(
      tbb::blocked_range<std::uint32_t>(0, layout.gaussian_count, 4096), [&](const auto& range) {
        for (std::uint32_t slot = range.begin(); slot != range.end(); ++slot) {
          const std::uint32_t index = storage_order[slot];
          const Gaussian<float>& g = cloud.gaussians[index];
          encode_first_half(g, image.bytes.data() + layout.first_half_address(slot));
          encode_raw_second_half(g, cloud.sh(index), cloud.sh_degree,
                                 image.bytes.data() + layout.second_half_address(slot));
        }
      });
}

}  // namespace

MemoryImage build_memory_image(const ActivatedCloud& cloud, const VoxelGrid& grid,
                               std::uint64_t spill_bytes, std::uint64_t frame_bytes) {
  MemoryImage image;
  MemoryLayout& layout = image.layout;
  layout.voxel_frame = grid.frame;
  layout.node_count = static_cast<std::uint32_t>(grid.nodes.size());
  layout.voxel_count = static_cast<std::uint32_t>(grid.voxels.size());
  layout.gaussian_count = static_cast<std::uint32_t>(grid.storage_order.size());
  layout.sh_degree = cloud.sh_degree;
  RegionSizes sizes = common_sizes(cloud, grid.storage_order.size(), spill_bytes, frame_bytes);
  sizes[region_id(Region::kVoxelTable)] =
      grid.nodes.size() * sizeof(VoxelNode) + grid.voxels.size() * sizeof(VoxelRecord);
  place_regions(sizes, layout);
  image.bytes.resize(layout[Region::kSpill].base);
  copy_table(grid.nodes, layout.node_address(0), image);
  copy_table(grid.voxels, layout.voxel_address(0), image);
  store_gaussians(cloud, grid.storage_order, image);
  return image;
}

MemoryImage build_memory_image(const ActivatedCloud& cloud, const ChunkTree& tree,
                               std::uint64_t spill_bytes, std::uint64_t frame_bytes) {
  MemoryImage image;
  MemoryLayout& layout = image.layout;
  layout.chunk_node_count = static_cast<std::uint32_t>(tree.nodes.size());
  layout.chunk_count = tree.chunk_count;
  layout.gaussian_count = static_cast<std::uint32_t>(tree.storage_order.size());
  layout.sh_degree = cloud.sh_degree;
  RegionSizes sizes = common_sizes(cloud, tree.storage_order.size(), spill_bytes, frame_bytes);
  sizes[region_id(Region::kChunkTable)] = tree.nodes.size() * sizeof(ChunkNode);
  sizes[region_id(Region::kIndices)] = tree.storage_order.size() * sizeof(std::uint32_t);
  place_regions(sizes, layout);
  image.bytes.resize(layout[Region::kSpill].base);
  copy_table(tree.nodes, layout.chunk_node_address(0), image);
  copy_table(tree.storage_order, layout.index_address(0), image);
  store_gaussians(cloud, tree.storage_order, image);
  return image;
}

}  // namespace sgs
