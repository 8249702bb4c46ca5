// The storage orders of this project, a line each, and the rules behind what is left open.
#include "algorithm/storage/storage_scheme.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "algorithm/memory/records.h"
#include "algorithm/voxel/voxel_grid.h"

namespace sgs {

const StorageScheme& scheme_of(StorageOrder order) {
  static const std::array<const StorageScheme*, std::variant_size_v<TableLayout>> schemes = {
      &voxel_scheme(), &chunk_scheme(), &file_scheme()};  // [StorageOrder]
  return *schemes.at(static_cast<std::size_t>(order));
}

Choice<double> choose_voxel_size(const ActivatedCloud& cloud, VoxelRule rule) {
  if (rule != VoxelRule::kExtent) {
    const bool real = rule == VoxelRule::kReal;
    return {real ? kRealVoxelSize : kSmallVoxelSize,
            fmt::format("the paper's for {} scenes, as storage.voxel_rule says",
                        real ? "real" : "synthetic")};
  }
  const float extent = inner_extent(cloud);
  const bool small = !(extent > kSmallSceneExtent);
  return {paper_voxel_size(extent),
          fmt::format("the paper's for {} scenes: all but the outermost 0.1 % of the centres lie "
                      "within {:.3g} world units along every axis, {} {}",
                      small ? "small" : "real", extent, small ? "at most" : "more than",
                      kSmallSceneExtent)};
}

Choice<std::uint32_t> choose_chunk_gaussians(std::uint32_t run_bytes) {
  const std::uint32_t chunk = std::clamp(run_bytes / kFirstHalfBytes, 1U, 64U);
  return {
      chunk,
      fmt::format("{} first halves of {} B fill the {} B that lie together in a row of a channel",
                  chunk, kFirstHalfBytes, run_bytes)};
}

}  // namespace sgs
