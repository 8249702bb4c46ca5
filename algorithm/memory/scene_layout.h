// What lies where of a stored scene: what every storage order has, and the tables of one of them.
#pragma once

#include <array>
#include <cstdint>
#include <variant>

#include "algorithm/memory/regions.h"
#include "algorithm/memory/second_half.h"
#include "algorithm/voxel/voxel_grid.h"

namespace sgs {

// What the records are sorted by, and which table finds them.
enum class StorageOrder : std::uint8_t { kVoxels, kChunks };

constexpr std::array<const char*, 2> kStorageOrderNames = {"voxels", "chunks"};

struct VoxelTableLayout {
  VoxelFrame frame;
  RecordArray nodes, voxels;  // VoxelNode, VoxelRecord
};

struct ChunkTableLayout {
  RecordArray nodes;    // ChunkNode
  RecordArray indices;  // 32-bit file index of each slot
  std::uint32_t chunk_count = 0;
};

struct SceneLayout {
  Regions regions;  // the scene's; machines add what they work with behind them
  SecondHalfFormat second_half;
  RecordArray first_halves, second_halves;  // [slots]
  RegionSpan codebooks;
  std::variant<VoxelTableLayout, ChunkTableLayout> table;
  std::uint64_t stored_bytes = 0;  // of the scene's image, from address 0 on

  std::uint32_t gaussian_count() const { return static_cast<std::uint32_t>(first_halves.count); }
  int sh_degree() const { return second_half.sh_degree; }
  StorageOrder order() const {
    return std::holds_alternative<ChunkTableLayout>(table) ? StorageOrder::kChunks
                                                           : StorageOrder::kVoxels;
  }
  // Of a scene in this order; std::bad_variant_access in the other.
  const VoxelTableLayout& voxel_table() const { return std::get<VoxelTableLayout>(table); }
  const ChunkTableLayout& chunk_table() const { return std::get<ChunkTableLayout>(table); }
};

// By voxels: voxel_table (nodes, then voxels), first_halves, second_halves, codebooks.
SceneLayout lay_out_voxels(const SecondHalfFormat& format, std::uint32_t gaussians,
                           const VoxelFrame& frame, std::uint32_t nodes, std::uint32_t voxels);

// By chunks: first_halves, second_halves, codebooks, chunk_table, indices.
SceneLayout lay_out_chunks(const SecondHalfFormat& format, std::uint32_t gaussians,
                           std::uint32_t nodes, std::uint32_t chunks);

}  // namespace sgs
