// What lies where in the modelled DRAM: regions, addresses, and the bytes of a scene.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "algorithm/memory/encoded_cloud.h"
#include "algorithm/memory/frame_buffer.h"
#include "algorithm/memory/region.h"
#include "algorithm/voxel/chunk_tree.h"
#include "algorithm/voxel/voxel_grid.h"

namespace sgs {

struct RegionRange {
  std::uint64_t base = 0, bytes = 0;
  std::uint64_t end() const { return base + bytes; }
};

// What the records are sorted by, and which table finds them.
enum class StorageOrder : std::uint8_t { kVoxels, kChunks };

// Addresses of the records; what the units are configured with before a frame. Regions begin on
// multiples of 4 KiB, the row size of a DRAM page.
struct MemoryLayout {
  std::array<RegionRange, kRegionCount> regions;
  StorageOrder storage_order = StorageOrder::kVoxels;
  VoxelFrame voxel_frame;
  std::uint32_t node_count = 0, voxel_count = 0;        // by voxels
  std::uint32_t chunk_node_count = 0, chunk_count = 0;  // by chunks
  std::uint32_t gaussian_count = 0;                     // stored
  SecondHalfFormat second_half;

  const RegionRange& operator[](Region region) const { return regions[region_id(region)]; }
  std::uint64_t total_bytes() const { return regions.back().end(); }
  int sh_degree() const { return second_half.sh_degree; }
  std::uint32_t second_half_bytes() const { return second_half.bytes(); }

  std::uint64_t node_address(std::uint32_t node) const {
    return (*this)[Region::kVoxelTable].base + std::uint64_t{node} * sizeof(VoxelNode);
  }
  std::uint64_t voxel_address(std::uint32_t voxel) const {
    return node_address(node_count) + std::uint64_t{voxel} * sizeof(VoxelRecord);
  }
  std::uint64_t chunk_node_address(std::uint32_t node) const {
    return (*this)[Region::kChunkTable].base + std::uint64_t{node} * sizeof(ChunkNode);
  }
  std::uint64_t index_address(std::uint32_t slot) const {
    return (*this)[Region::kIndices].base + std::uint64_t{slot} * sizeof(std::uint32_t);
  }
  std::uint64_t first_half_address(std::uint32_t slot) const {
    return (*this)[Region::kFirstHalves].base + std::uint64_t{slot} * kFirstHalfBytes;
  }
  std::uint64_t second_half_address(std::uint32_t slot) const {
    return (*this)[Region::kSecondHalves].base + std::uint64_t{slot} * second_half_bytes();
  }
  std::uint64_t pixel_address(int x, int y, int width_px, FrameFormat format) const {
    return (*this)[Region::kFrameBuffer].base +
           (static_cast<std::uint64_t>(y) * width_px + x) * pixel_bytes(format);
  }
};

// A scene laid out for one of the orders: its layout, and the bytes of the regions that hold it.
struct MemoryImage {
  MemoryLayout layout;           // spill and frame buffer are still empty
  std::vector<std::byte> bytes;  // from address 0 to the first region that a frame writes
};

// The grid or tree is of scene.decoded.
MemoryImage build_memory_image(const EncodedCloud& scene, const VoxelGrid& grid);
MemoryImage build_memory_image(const EncodedCloud& scene, const ChunkTree& tree);

// Gives every region its place and size, which follow from the layout's counts and its format.
void place_regions(MemoryLayout& layout, std::uint64_t spill_bytes, std::uint64_t frame_bytes);

// The layout with room for what a frame writes.
MemoryLayout with_working_regions(MemoryLayout layout, std::uint64_t spill_bytes,
                                  std::uint64_t frame_bytes);

}  // namespace sgs
