// The layout of a stored scene in the modelled DRAM: the records that every storage order has, and
// the tables of one of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "algorithm/memory/record_split.h"
#include "algorithm/memory/second_half.h"
#include "algorithm/voxel/voxel_grid.h"

namespace sgs {

// The number of a region, which each transaction carries.
using RegionId = std::uint8_t;

constexpr std::uint64_t kRegionAlignment = 4096;  // the row size of a DRAM page

struct Region {
  std::string name;  // as reports call it
  std::uint64_t base = 0, bytes = 0;
  std::uint64_t end() const { return base + bytes; }
};

// Records of one size, one behind the other, in a region or a piece of one.
struct RecordArray {
  RegionId region = 0;
  std::uint64_t base = 0;
  std::uint32_t record_bytes = 0;
  std::uint64_t count = 0;
  std::uint64_t bytes() const { return count * record_bytes; }
  std::uint64_t end() const { return base + bytes(); }
  std::uint64_t address(std::uint64_t record) const { return base + record * record_bytes; }
};

// A region, or a piece of one, as units know it: where it lies, and whose bytes these are.
struct RegionSpan {
  RegionId region = 0;
  std::uint64_t base = 0, bytes = 0;
  std::uint64_t end() const { return base + bytes; }
  // The piece from `offset` on.
  RegionSpan part(std::uint64_t offset, std::uint64_t size) const {
    return {region, base + offset, size};
  }
  RecordArray records(std::uint64_t offset, std::uint32_t record_bytes, std::uint64_t count) const {
    return {region, base + offset, record_bytes, count};
  }
};

class Regions {
 public:
  // Behind all others, from the next multiple of kRegionAlignment on. Throws std::invalid_argument
  // for a name that is taken and std::length_error when there are more than a RegionId can tell
  // apart.
  RegionSpan add(const std::string& name, std::uint64_t bytes);
  RecordArray add_records(const std::string& name, std::uint32_t record_bytes, std::uint64_t count);

  std::size_t size() const { return regions_.size(); }
  const Region& operator[](RegionId id) const { return regions_[id]; }
  std::vector<Region>::const_iterator begin() const { return regions_.begin(); }
  std::vector<Region>::const_iterator end() const { return regions_.end(); }

  std::uint64_t total_bytes() const { return regions_.empty() ? 0 : regions_.back().end(); }
  // Where the next region would begin.
  std::uint64_t next_base() const;

 private:
  std::vector<Region> regions_;  // [RegionId]
};

// The key by which records are sorted, and so the table that finds them. All else of an order:
// ../storage/storage_scheme.h.
enum class StorageOrder : std::uint8_t { kVoxels, kChunks, kFile };

// By voxels the halves are the paper's; by chunks whole bursts count, and by file, where every
// first half is read, those that leave the first halves as short.
RecordSplit split_of(StorageOrder order, const SecondHalfFormat& format);

struct VoxelTableLayout {
  VoxelFrame frame;
  RecordArray nodes, voxels, cuts;  // VoxelNode, VoxelRecord, float (voxel_grid.h)
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
