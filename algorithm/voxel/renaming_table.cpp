// Filling of the renaming table from the tree.
#include "algorithm/voxel/renaming_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "algorithm/files/input_error.h"
#include "algorithm/voxel/cell_samples.h"

namespace sgs {
namespace {

constexpr unsigned kVidBits = 44, kVoxelBits = 20;  // of an entry of the hashed form
constexpr unsigned kDenseBits = 24;  // of the numbers that the dense form has room for
constexpr std::uint64_t kFree = ~std::uint64_t{0};
constexpr std::uint32_t kNoVoxel = ~0U;

unsigned bits_for(int cells) {
  unsigned bits = 0;
  while ((1LL << bits) < cells) ++bits;
  return bits;
}

// Calls visit(cell, voxel) for all voxels below a block of 4^level cells a side.
template <class Visit>
void for_each_voxel(const VoxelGrid& grid, std::uint32_t block, int level, const glm::ivec3& cell,
                    const Visit& visit) {
  if (level == 0) {
    visit(cell, block);
    return;
  }
  const VoxelNode& node = grid.nodes[block];
  std::uint32_t child = node.first_child;
  for (unsigned bit = 0; bit < 64; ++bit) {
    if ((node.occupied >> bit & 1U) == 0) continue;
    const auto along = [&](unsigned axis) {
      return static_cast<int>((bit >> axis & 1U) | (bit >> (axis + 3) & 1U) << 1U);
    };
    const glm::ivec3 at = glm::ivec3(along(0), along(1), along(2)) * (1 << (2 * (level - 1)));
    for_each_voxel(grid, child++, level - 1, cell + at, visit);
  }
}
template <class Visit>
void for_each_voxel(const VoxelGrid& grid, const Visit& visit) {
  if (!grid.nodes.empty()) for_each_voxel(grid, 0, grid.frame.levels, glm::ivec3(0), visit);
}

std::uint32_t hashed_lines(std::size_t voxels) {
  std::uint32_t lines = 1;
  while (kRenamedInLine * lines < 2 * voxels) lines *= 2;
  return lines;
}

void check_size(const CellNumbers& numbers, std::size_t voxels, RenamingForm form) {
  const unsigned most = form == RenamingForm::kDense ? kDenseBits : kVidBits;
  if (numbers.bits() > most) {
    throw InputError(fmt::format(
        "vsu.renaming: the numbers of the scene's cells have {} bits, expected at most {}{}",
        numbers.bits(), most,
        form == RenamingForm::kDense ? ", or hashed"
                                     : ": larger voxels, or rays through the tree"));
  }
  if (form == RenamingForm::kHashed && voxels >= (std::size_t{1} << kVoxelBits)) {
    throw InputError(fmt::format("vsu.renaming: the scene has {} voxels, expected less than {}",
                                 voxels, std::size_t{1} << kVoxelBits));
  }
}

// Samples are numbered from the eye in single precision. It has twice as many whole numbers in a
// row, so that none stays the same where one is added.
void check_numbers(const SampleSpace& space) {
  constexpr double kMost = 1 << 23;
  double squares = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double eye = space.eye[axis], box = space.box[axis];
    const double farthest = std::max(std::abs(eye), std::abs(box - eye));
    squares += farthest * farthest;
  }
  const double cells = std::sqrt(squares);
  if (std::min(cells / space.step, double{space.far}) <= kMost) return;
  throw InputError(fmt::format(
      "vsu.sample_step_voxels: got {:g}, expected at least {:.2g}: the scene reaches {:.3g} voxels "
      "from the eye, and {} samples have a number",
      space.step, cells / kMost, cells, kMost));
}

}  // namespace

glm::ivec3 occupied_cells(const VoxelGrid& grid) {
  glm::ivec3 cells(0);
  for_each_voxel(grid, [&](const glm::ivec3& cell, std::uint32_t) {
    for (int axis = 0; axis < 3; ++axis) cells[axis] = std::max(cells[axis], cell[axis] + 1);
  });
  return cells;
}

SampleSpace sample_space(const glm::vec3& eye, const VoxelFrame& frame, const glm::ivec3& cells,
                         float step_voxels, float far_voxels) {
  SampleSpace space;
  for (int axis = 0; axis < 3; ++axis) {
    const double at = static_cast<double>(eye[axis]) / frame.voxel_size - frame.origin_cell[axis];
    space.eye[axis] = static_cast<float>(at);
    space.box[axis] = static_cast<float>(cells[axis]);
  }
  space.step = step_voxels;
  space.far = far_voxels > 0 ? far_voxels / step_voxels : std::numeric_limits<float>::infinity();
  check_numbers(space);
  return space;
}

CellNumbers::CellNumbers(const glm::ivec3& cells)
    : y_(bits_for(cells.x)), z_(y_ + bits_for(cells.y)), bits_(z_ + bits_for(cells.z)) {}

std::uint32_t RenamingLookUp::first(std::uint64_t vid) const {
  if (form == RenamingForm::kDense) return static_cast<std::uint32_t>(vid / (2 * kRenamedInLine));
  // Neighbouring cells have neighbouring numbers: three shifts and exclusive ors spread them
  // (Marsaglia, "Xorshift RNGs", 2003).
  vid ^= vid << 13U;
  vid ^= vid >> 7U;
  vid ^= vid << 17U;
  return static_cast<std::uint32_t>(vid >> 32U ^ vid) & (lines - 1);
}

Renamed RenamingLookUp::read(std::uint64_t vid, const RenamingLine& line) const {
  if (form == RenamingForm::kDense) {
    const std::uint64_t both = line[vid / 2 % kRenamedInLine];
    const auto voxel = static_cast<std::uint32_t>(both >> (32 * (vid % 2)));
    if (voxel == kNoVoxel) return {Renamed::What::kEmpty};
    return {Renamed::What::kVoxel, voxel};
  }
  for (const std::uint64_t entry : line) {
    if (entry == kFree) return {Renamed::What::kEmpty};
    if (entry >> kVoxelBits != vid) continue;
    return {Renamed::What::kVoxel,
            static_cast<std::uint32_t>(entry & ((std::uint64_t{1} << kVoxelBits) - 1))};
  }
  return {Renamed::What::kLookOn};
}

RenamingTable renaming_table(const VoxelGrid& grid, RenamingForm form) {
  RenamingTable table;
  table.numbers = CellNumbers(occupied_cells(grid));
  check_size(table.numbers, grid.voxels.size(), form);
  const bool dense = form == RenamingForm::kDense;
  const std::uint64_t cells = std::uint64_t{1} << table.numbers.bits(),
                      in_line = 2 * kRenamedInLine;
  table.look_up = {form, dense ? static_cast<std::uint32_t>((cells + in_line - 1) / in_line)
                               : hashed_lines(grid.voxels.size())};
  RenamingLine free;
  free.fill(kFree);
  table.lines.assign(table.look_up.lines, free);
  for_each_voxel(grid, [&](const glm::ivec3& cell, std::uint32_t voxel) {
    const std::uint64_t vid = table.numbers.of(cell);
    std::uint32_t at = table.look_up.first(vid);
    if (dense) {
      std::uint64_t& both = table.lines[at][vid / 2 % kRenamedInLine];
      const unsigned shift = 32 * (vid % 2);
      both &= ~(std::uint64_t{kNoVoxel} << shift);
      both |= std::uint64_t{voxel} << shift;
      return;
    }
    while (table.lines[at].back() != kFree) at = table.look_up.behind(at);
    RenamingLine& line = table.lines[at];
    *std::find(line.begin(), line.end(), kFree) = vid << kVoxelBits | voxel;
  });
  return table;
}

}  // namespace sgs
