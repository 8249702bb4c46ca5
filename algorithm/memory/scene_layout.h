// The layout of a stored scene in the modelled DRAM: the records that every storage order has, and
// the tables of one of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <variant>
#include <vector>

#include "algorithm/memory/record_split.h"
#include "algorithm/memory/regions.h"
#include "algorithm/memory/second_half.h"
#include "algorithm/voxel/voxel_grid.h"

namespace sgs {

// The key by which records are sorted, and so the table that finds them. All else of an order:
// ../storage/storage_scheme.h.
enum class StorageOrder : std::uint8_t { kVoxels, kChunks, kFile };

// By voxels the halves are the paper's; by chunks whole bursts count, and by file, where every
// first half is read, those that leave the first halves as short.
RecordSplit split_of(StorageOrder order, const SecondHalfFormat& format);

struct VoxelTableLayout {
  VoxelFrame frame;
  RecordArray nodes, voxels, cuts;  // VoxelNode, VoxelRecord, float (voxel_cuts.h)
};

struct ChunkTableLayout {
  RecordArray nodes;  // ChunkNode
  std::uint32_t chunk_count = 0;
};

// All of the scene's are read: nothing to find records with.
struct NoTableLayout {};

// [StorageOrder]
using TableLayout = std::variant<VoxelTableLayout, ChunkTableLayout, NoTableLayout>;

inline StorageOrder order_of(const TableLayout& table) {
  return static_cast<StorageOrder>(table.index());
}

struct SceneLayout {
  Regions regions;               // the scene's; machines add what they work with behind them
  SecondHalfFormat second_half;  // as encoded, before it is split
  RecordSplit split;             // which words of it lie in which half
  RecordArray first_halves, second_halves;  // [slots]
  RegionSpan codebooks;
  TableLayout table;
  std::uint64_t stored_bytes = 0;  // the scene's image, from address 0 on

  std::uint32_t gaussian_count() const { return static_cast<std::uint32_t>(first_halves.count); }
  std::uint64_t record_bytes() const {  // both halves of a Gaussian
    return std::uint64_t{first_halves.record_bytes} + second_halves.record_bytes;
  }
  int sh_degree() const { return second_half.sh_degree; }
  StorageOrder order() const { return order_of(table); }
  // For who reads scenes of this order alone; std::bad_variant_access in the others.
  const VoxelTableLayout& voxel_table() const { return std::get<VoxelTableLayout>(table); }
  const ChunkTableLayout& chunk_table() const { return std::get<ChunkTableLayout>(table); }
};

// By voxels: voxel_table (nodes, then voxels), first_halves, second_halves, codebooks.
SceneLayout lay_out_voxels(const SecondHalfFormat& format, std::uint32_t gaussians,
                           const VoxelFrame& frame, std::uint32_t nodes, std::uint32_t voxels);

// By chunks: first_halves, second_halves, codebooks, chunk_table.
SceneLayout lay_out_chunks(const SecondHalfFormat& format, std::uint32_t gaussians,
                           std::uint32_t nodes, std::uint32_t chunks);

// By file: first_halves, second_halves, codebooks.
SceneLayout lay_out_file(const SecondHalfFormat& format, std::uint32_t gaussians);

struct MemoryImage {
  SceneLayout layout;            // the scene's alone
  std::vector<std::byte> bytes;  // [layout.stored_bytes] from address 0 on

  const std::byte* at(std::uint64_t address) const { return bytes.data() + address; }
};

}  // namespace sgs
