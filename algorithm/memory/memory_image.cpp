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

MemoryLayout lay_out(const ActivatedCloud& cloud, const VoxelGrid& grid, std::uint64_t spill_bytes,
                     std::uint64_t frame_bytes) {
  MemoryLayout layout;
  layout.voxel_frame = grid.frame;
  layout.node_count = static_cast<std::uint32_t>(grid.nodes.size());
  layout.voxel_count = static_cast<std::uint32_t>(grid.voxels.size());
  layout.gaussian_count = static_cast<std::uint32_t>(grid.storage_order.size());
  layout.sh_degree = cloud.sh_degree;
  const std::uint64_t sizes[kRegionCount] = {
      grid.nodes.size() * sizeof(VoxelNode) + grid.voxels.size() * sizeof(VoxelRecord),
      grid.storage_order.size() * kFirstHalfBytes,
      grid.storage_order.size() * raw_second_half_bytes(cloud.sh_degree),
      spill_bytes,
      frame_bytes,
  };
  std::uint64_t base = 0;
  for (std::size_t region = 0; region < kRegionCount; ++region) {
    layout.regions[region] = {base, sizes[region]};
    base = aligned(base + sizes[region]);
  }
  return layout;
}

}  // namespace

MemoryImage build_memory_image(const ActivatedCloud& cloud, const VoxelGrid& grid,
                               std::uint64_t spill_bytes, std::uint64_t frame_bytes) {
  MemoryImage image;
  image.layout = lay_out(cloud, grid, spill_bytes, frame_bytes);
  const MemoryLayout& layout = image.layout;
  image.bytes.resize(layout[Region::kSecondHalves].end());
  if (layout.gaussian_count == 0) return image;
  std::memcpy(image.bytes.data() + layout.node_address(0), grid.nodes.data(),
              grid.nodes.size() * sizeof(VoxelNode));
  std::memcpy(image.bytes.data() + layout.voxel_address(0), grid.voxels.data(),
              grid.voxels.size() * sizeof(VoxelRecord));
  tbb::parallel_for(
      tbb::blocked_range<std::uint32_t>(0, layout.gaussian_count, 4096), [&](const auto& range) {
        for (std::uint32_t slot = range.begin(); slot != range.end(); ++slot) {
          const std::uint32_t index = grid.storage_order[slot];
          const Gaussian<float>& g = cloud.gaussians[index];
          encode_first_half(g, image.bytes.data() + layout.first_half_address(slot));
          encode_raw_second_half(g, cloud.sh(index), cloud.sh_degree,
                                 image.bytes.data() + layout.second_half_address(slot));
        }
      });
  return image;
}

}  // namespace sgs
