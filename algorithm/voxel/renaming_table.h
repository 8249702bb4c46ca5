// The renaming table of StreamingGS (DAC 2025): from a voxel's number by its coordinates (VID) to
// its place among the voxels that hold Gaussians. It takes away the empty ones.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "algorithm/voxel/voxel_grid.h"

namespace sgs {

// Dense: an entry for each cell of the box, empty or not. Hashed: linear probing, at most three
// quarters of the entries taken.
enum class RenamingForm : std::uint8_t { kHashed, kDense };

// A record in memory: an entry of the hashed form (VID, voxel), or two of the dense one (voxels).
using RenamingRecord = std::uint64_t;

// Numbers of the cells of a box: the bits of their coordinates, side by side.
class CellNumbers {
 public:
  CellNumbers() = default;
  explicit CellNumbers(const glm::ivec3& cells);
  std::uint64_t of(const glm::ivec3& cell) const {
    return static_cast<std::uint64_t>(cell.x) | static_cast<std::uint64_t>(cell.y) << y_ |
           static_cast<std::uint64_t>(cell.z) << z_;
  }
  unsigned bits() const { return bits_; }

 private:
  unsigned y_ = 0, z_ = 0, bits_ = 0;
};

// What a record says of a number.
struct Renamed {
  enum class What : std::uint8_t { kEmpty, kVoxel, kLookOn } what;
  std::uint32_t voxel = 0;
};

// How records are found and read.
struct RenamingLookUp {
  RenamingForm form = RenamingForm::kHashed;
  std::uint32_t records = 0;  // hashed: a power of two

  std::uint32_t first(std::uint64_t vid) const;
  std::uint32_t behind(std::uint32_t record) const { return (record + 1) & (records - 1); }
  Renamed read(std::uint64_t vid, RenamingRecord record) const;
};

struct RenamingTable {
  CellNumbers numbers;
  RenamingLookUp look_up;
  std::vector<RenamingRecord> records;
};

// Throws InputError where the box has too many cells for the form, or the grid too many voxels.
RenamingTable renaming_table(const VoxelGrid& grid, RenamingForm form);

}  // namespace sgs
