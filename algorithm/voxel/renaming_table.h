// The renaming table of StreamingGS (DAC 2025): from a voxel's number by its coordinates (VID) to
// its place among the voxels that hold Gaussians. It takes away the empty ones.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "algorithm/voxel/voxel_grid.h"

namespace sgs {

// Dense: an entry for each cell of the box, empty or not. Hashed: a line of entries for each value
// of the hash, then the line behind it; at most half of the entries are taken.
enum class RenamingForm : std::uint8_t { kHashed, kDense };

// A line in memory, read and compared at once: four entries of the hashed form (VID and voxel), or
// eight of the dense one (voxels).
constexpr std::size_t kRenamedInLine = 4;
using RenamingLine = std::array<std::uint64_t, kRenamedInLine>;

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

// What a line says of a number.
struct Renamed {
  enum class What : std::uint8_t { kEmpty, kVoxel, kLookOn } what;
  std::uint32_t voxel = 0;
};

// How lines are found and read.
struct RenamingLookUp {
  RenamingForm form = RenamingForm::kHashed;
  std::uint32_t lines = 0;  // hashed: a power of two

  std::uint32_t first(std::uint64_t vid) const;
  std::uint32_t behind(std::uint32_t line) const { return (line + 1) & (lines - 1); }
  Renamed read(std::uint64_t vid, const RenamingLine& line) const;
};

struct RenamingTable {
  CellNumbers numbers;
  RenamingLookUp look_up;
  std::vector<RenamingLine> lines;
};

// Throws InputError where the box has too many cells for the form, or the grid too many voxels.
RenamingTable renaming_table(const VoxelGrid& grid, RenamingForm form);

}  // namespace sgs
