// Stored by voxels: each voxel's Gaussians together, found by a tree of occupied cells.
#include <fmt/format.h>

#include <cstring>
#include <limits>
#include <optional>

#include "algorithm/files/input_error.h"
#include "algorithm/storage/decoded_image.h"
#include "algorithm/storage/encoded_cloud.h"
#include "algorithm/storage/storage_scheme.h"
#include "algorithm/voxel/voxel_grid.h"

namespace sgs {
namespace {

// Reading of the voxel table, level by level.

// Where child `bit` lies in the 4x4x4 block of its node: the inverse of child_bit().
glm::ivec3 place_of(unsigned bit) {
  const auto along = [&](unsigned axis) {
    return static_cast<int>((bit >> axis & 1U) | (bit >> (axis + 3) & 1U) << 1U);
  };
  return {along(0), along(1), along(2)};
}

// Cells of all voxels, relative to the root's corner.
std::vector<glm::ivec3> voxel_cells(const VoxelGrid& grid, const std::string& source) {
  if (grid.nodes.empty()) return {};
  std::vector<glm::ivec3> blocks{glm::ivec3(0)};  // blocks of one level
  std::size_t level_begin = 0;                    // its first node
  for (int level = 0; level < grid.frame.levels; ++level) {
    const bool last = level + 1 == grid.frame.levels;
    const std::size_t base = last ? 0 : level_begin + blocks.size();
    const std::size_t limit = last ? grid.voxels.size() : grid.nodes.size();
    std::vector<glm::ivec3> children;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      const VoxelNode& node = grid.nodes[level_begin + i];
      const std::size_t first = base + children.size();
      const auto count = static_cast<std::size_t>(__builtin_popcountll(node.occupied));
      if (count == 0 || node.first_child != first || first + count > limit) {
        throw InputError(fmt::format(
            "{}: voxel table: node {}: got {} children from {}, expected 1 or more from {}, none "
            "beyond {}",
            source, level_begin + i, count, node.first_child, first, limit));
      }
      for (unsigned bit = 0; bit < 64; ++bit) {
        if ((node.occupied >> bit & 1U) != 0) children.push_back(blocks[i] * 4 + place_of(bit));
      }
    }
    level_begin += blocks.size();
    blocks = std::move(children);
  }
  if (level_begin != grid.nodes.size() || blocks.size() != grid.voxels.size()) {
    throw InputError(fmt::format("{}: voxel table: {} nodes lead to {} voxels, expected {} to {}",
                                 source, level_begin, blocks.size(), grid.nodes.size(),
                                 grid.voxels.size()));
  }
  return blocks;
}

// Records follow each other and hold all slots.
void check_records(const VoxelGrid& grid, std::uint32_t gaussians, const std::string& source) {
  std::uint64_t next = 0;
  for (std::size_t v = 0; v < grid.voxels.size(); ++v) {
    const VoxelRecord& record = grid.voxels[v];
    if (record.first != next || record.count == 0 || next + record.count > gaussians) {
      throw InputError(fmt::format(
          "{}: voxel table: voxel {}: got {} slots from {}, expected 1 or more from {}, none "
          "beyond {}",
          source, v, record.count, record.first, next, gaussians));
    }
    next += record.count;
  }
  if (next != gaussians) {
    throw InputError(fmt::format("{}: voxel table: its voxels hold {} Gaussians, expected {}",
                                 source, next, gaussians));
  }
}

// Each cut of a voxel lies between what it parts. Returns what is wrong.
std::optional<std::string> fault_of_cuts(const VoxelGrid& grid, const ActivatedCloud& decoded,
                                         const VoxelRecord& piece, int axis,
                                         const std::string& source) {
  if (piece.count <= kLeastCut) return {};
  const std::uint32_t cut = cut_slot(piece), end = piece.first + piece.count;
  const float plane = grid.cuts[cut_index(cut)];
  for (std::uint32_t slot = piece.first; slot < end; ++slot) {
    const float at = decoded.gaussians[slot].mean[axis];
    if (slot < cut ? at <= plane : at >= plane) continue;
    return fmt::format(
        "{}: Gaussian in slot {}: got {} along axis {}, expected {} {}: its voxel "
        "is cut there at slot {}",
        source, slot, at, axis, slot < cut ? "at most" : "at least", plane, cut);
  }
  const int next = (axis + 1) % 3;
  auto fault = fault_of_cuts(grid, decoded, {piece.first, cut - piece.first}, next, source);
  return fault ? fault : fault_of_cuts(grid, decoded, {cut, end - cut}, next, source);
}

// The table of an image, with nothing in it believed. decoded: the Gaussians by slot. source: what
// errors name. Throws InputError for a table that no builder could have made: every node and voxel
// is reached once, and every Gaussian lies in the cell of its voxel.
VoxelGrid read_voxel_table(const MemoryImage& image, const ActivatedCloud& decoded,
                           const std::string& source) {
  const VoxelTableLayout& layout = image.layout.voxel_table();
  const std::uint32_t gaussians = image.layout.gaussian_count();
  VoxelGrid grid;
  grid.frame = layout.frame;
  grid.nodes.resize(layout.nodes.count);
  grid.voxels.resize(layout.voxels.count);
  if (layout.nodes.count > 0) {
    std::memcpy(grid.nodes.data(), image.at(layout.nodes.base),
                grid.nodes.size() * sizeof(VoxelNode));
  }
  if (layout.voxels.count > 0) {
    std::memcpy(grid.voxels.data(), image.at(layout.voxels.base),
                grid.voxels.size() * sizeof(VoxelRecord));
  }
  grid.cuts.resize(layout.cuts.count);
  if (layout.cuts.count > 0) {
    std::memcpy(grid.cuts.data(), image.at(layout.cuts.base), grid.cuts.size() * sizeof(float));
  }

  check_records(grid, gaussians, source);
  const std::vector<glm::ivec3> cells = voxel_cells(grid, source);
  if (cells.size() != grid.voxels.size()) {
    throw InputError(fmt::format("{}: voxel table: no node leads to {} voxels", source,
                                 grid.voxels.size() - cells.size()));
  }
  const auto fault = first_fault(cells.size(), [&](std::size_t v) -> std::optional<std::string> {
    const VoxelRecord& record = grid.voxels[v];
    for (std::uint32_t slot = record.first; slot < record.first + record.count; ++slot) {
      for (int axis = 0; axis < 3; ++axis) {
        const std::int64_t cell =
            std::int64_t{cell_of(decoded.gaussians[slot].mean[axis], grid.frame.voxel_size)} -
            grid.frame.origin_cell[axis];
        if (cell == cells[v][axis]) continue;
        return fmt::format(
            "{}: Gaussian in slot {}: got cell {} along axis {}, expected {}: that "
            "of its voxel {}",
            source, slot, cell, axis, cells[v][axis], v);
      }
    }
    return fault_of_cuts(grid, decoded, record, 0, source);
  });
  if (fault) throw InputError(*fault);
  return grid;
}

class VoxelScheme : public StorageScheme {
 public:
  const char* name() const override { return "voxels"; }

  std::vector<StorageSize> sizes() const override {
    return {{"voxel_size", &StorageConfig::voxel_size, 1e9, "world units; 0: as voxel_rule says"}};
  }
  bool has_voxel_rule() const override { return true; }

  using StorageScheme::choose;
  std::vector<StorageChoice> choose(StorageConfig& config,
                                    const ActivatedCloud& cloud) const override {
    if (config.voxel_size != 0) return {};
    const Choice<double> size = choose_voxel_size(cloud, config.voxel_rule);
    config.voxel_size = size.value;
    return {{"voxel_size", size.value, size.why}};
  }

  void check(const StorageConfig& config) const override {
    if (static_cast<float>(config.voxel_size) > 0) return;
    throw InputError(fmt::format("voxel_size: got {}, expected more than 0, as a 32-bit float",
                                 config.voxel_size));
  }

  Arrangement<StoredTable> arrange(const ActivatedCloud& decoded,
                                   const StorageConfig& config) const override {
    auto [grid, storage_order] =
        arrange_by_voxels(decoded, static_cast<float>(config.voxel_size), stored_of(config));
    return {std::move(grid), std::move(storage_order)};
  }
  MemoryImage image_of(const EncodedCloud& encoded, const StoredTable& table) const override {
    return build_memory_image(encoded, std::get<VoxelGrid>(table));
  }
  StoredTable restore(const PackedScene& packed, const ActivatedCloud& decoded,
                      const std::string& source) const override {
    return read_voxel_table(packed.image, decoded, source);
  }

  TableLayout empty_table() const override { return VoxelTableLayout{}; }

  void visit(TableFields& fields, StorageConfig& storage, TableLayout& layout) const override {
    constexpr double kLeastSize = std::numeric_limits<float>::denorm_min();
    constexpr double kMostSize = std::numeric_limits<float>::max();
    constexpr double kMostCells = 1 << 30, kMostLevels = 10;
    auto& table = std::get<VoxelTableLayout>(layout);
    fields("voxel_size", storage.voxel_size, kLeastSize, kMostSize);
    fields("voxel levels", table.frame.levels, 1, kMostLevels);
    fields("first cell, x", table.frame.origin_cell.x, -kMostCells, kMostCells);
    fields("first cell, y", table.frame.origin_cell.y, -kMostCells, kMostCells);
    fields("first cell, z", table.frame.origin_cell.z, -kMostCells, kMostCells);
    fields.count("voxel nodes", table.nodes.count);
    fields.count("voxels", table.voxels.count);
  }

  SceneLayout lay_out(const SecondHalfFormat& format, std::uint32_t gaussians,
                      const StorageConfig& storage, const TableLayout& layout) const override {
    const auto& table = std::get<VoxelTableLayout>(layout);
    VoxelFrame frame = table.frame;
    frame.voxel_size = static_cast<float>(storage.voxel_size);
    return lay_out_voxels(format, gaussians, frame, static_cast<std::uint32_t>(table.nodes.count),
                          static_cast<std::uint32_t>(table.voxels.count));
  }

  std::string in_words(const StorageConfig& config) const override {
    return fmt::format("voxels of {:.4g}", config.voxel_size);
  }
  std::optional<std::uint64_t> blocks(const TableLayout& table) const override {
    return std::get<VoxelTableLayout>(table).voxels.count;
  }
  std::string size_in_words(const StorageConfig& config) const override {
    return fmt::format("{:.4g} world units", config.voxel_size);
  }
  std::vector<StorageFact> facts(const TableLayout& layout) const override {
    const auto& table = std::get<VoxelTableLayout>(layout);
    return {{"voxel_size", "world units", "Stored by voxels: side of a voxel.",
             double{table.frame.voxel_size}},
            {"voxels", "", "Stored by voxels: occupied ones.", table.voxels.count}};
  }
};

}  // namespace

MemoryImage build_memory_image(const EncodedCloud& scene, const VoxelGrid& grid) {
  MemoryImage image = store_gaussians(
      scene, lay_out_voxels(scene.format, count_of(scene.decoded.gaussians), grid.frame,
                            count_of(grid.nodes), count_of(grid.voxels)));
  const VoxelTableLayout& table = image.layout.voxel_table();
  store_table(grid.nodes, table.nodes.base, image);
  store_table(grid.voxels, table.voxels.base, image);
  store_table(grid.cuts, table.cuts.base, image);
  return image;
}

const StorageScheme& voxel_scheme() {
  static const VoxelScheme scheme;
  return scheme;
}

}  // namespace sgs
