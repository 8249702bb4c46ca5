// Stored by voxels: each voxel's Gaussians together, found by a tree of occupied cells.
#include <fmt/format.h>

#include <limits>

#include "algorithm/input_error.h"
#include "algorithm/storage/build_memory_image.h"
#include "algorithm/storage/schemes.h"
#include "algorithm/storage/storage_scheme.h"
#include "algorithm/storage/stored_tables.h"

namespace sgs {
namespace {

class VoxelScheme : public StorageScheme {
 public:
  const char* name() const override { return "voxels"; }

  std::vector<StorageSize> sizes() const override {
    return {{"voxel_size", &StorageConfig::voxel_size, 1e9,
             "world units; 0: 0.4 for a scene below 10 units across, else 2"}};
  }

  using StorageScheme::choose;
  std::vector<StorageChoice> choose(StorageConfig& config,
                                    const ActivatedCloud& cloud) const override {
    if (config.voxel_size != 0) return {};
    const Choice<double> size = choose_voxel_size(cloud);
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
    return {{"voxel_size", double{table.frame.voxel_size}}, {"voxels", table.voxels.count}};
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
