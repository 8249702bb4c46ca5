// Building of the sparse voxel tree: one sort by Morton code, then the levels bottom up.
#include "algorithm/voxel/voxel_grid.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "algorithm/files/input_error.h"
#include "algorithm/splat/footprint.h"

namespace sgs {

namespace {

constexpr int kMaxLevels = 10;

// Spreads the low 21 bits of x to every third bit.
std::uint64_t spread_bits(std::uint64_t x) {
  x &= 0x1fffff;
  x = (x | x << 32) & 0x1f00000000ffff;
  x = (x | x << 16) & 0x1f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  return (x | x << 2) & 0x1249249249249249;
}

std::uint64_t morton(const glm::ivec3& cell) {
  return spread_bits(static_cast<std::uint64_t>(cell.x)) |
         spread_bits(static_cast<std::uint64_t>(cell.y)) << 1 |
         spread_bits(static_cast<std::uint64_t>(cell.z)) << 2;
}

// Corner and levels of the smallest root that holds all centres.
VoxelFrame fit_frame(const ActivatedCloud& cloud, const std::vector<std::uint32_t>& kept,
                     float voxel_size) {
  glm::vec3 low = cloud.gaussians[kept.front()].mean, high = low;
  for (const std::uint32_t index : kept) {
    const Gaussian<float>& g = cloud.gaussians[index];
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], g.mean[axis]);
      high[axis] = std::max(high[axis], g.mean[axis]);
    }
  }
  VoxelFrame frame{voxel_size, {}, 1};
  double extent = 0, reach = 0;
  for (int axis = 0; axis < 3; ++axis) {
    extent = std::max(extent, static_cast<double>(high[axis]) - low[axis]);
    reach = std::max({reach, std::abs(static_cast<double>(low[axis])),
                      std::abs(static_cast<double>(high[axis]))});
  }
  const double limit = 1 << (2 * kMaxLevels);
  const double least = std::max(extent / (limit - 2), reach / 1e9);
  if (voxel_size < least) {
    throw InputError(
        fmt::format("voxel_size: {} divides the scene's extent of {} into more than 2^20 cells an "
                    "axis; at least "
                    "{:.3g} is needed",
                    voxel_size, extent, least));
  }
  int side = 0;
  for (int axis = 0; axis < 3; ++axis) {
    frame.origin_cell[axis] = cell_of(low[axis], voxel_size);
    side = std::max(side, cell_of(high[axis], voxel_size) - frame.origin_cell[axis] + 1);
  }
  while (frame.side_cells() < side) ++frame.levels;
  return frame;
}

// Parents of a level, given the codes of its occupied blocks in order. Appends nothing to `codes`:
// returns the parents' nodes and replaces `codes` by theirs.
std::vector<VoxelNode> build_parents(std::vector<std::uint64_t>& codes) {
  std::vector<VoxelNode> parents;
  std::vector<std::uint64_t> parent_codes;
  for (std::size_t i = 0; i < codes.size(); ++i) {
    const std::uint64_t parent = codes[i] >> 6;
    if (parent_codes.empty() || parent_codes.back() != parent) {
      parent_codes.push_back(parent);
      parents.push_back({0, static_cast<std::uint32_t>(i), 0});
    }
    parents.back().occupied |= std::uint64_t{1} << (codes[i] & 63);
  }
  codes = std::move(parent_codes);
  return parents;
}

struct Cutter {
  const ActivatedCloud& cloud;
  std::vector<std::uint32_t>& order;
  std::vector<float>& planes;

  float at(std::uint32_t index, int axis) const { return cloud.gaussians[index].mean[axis]; }

  // The plane is the smallest coordinate behind it. Where many are equal, some of them lie on
  // either side, all of them on the plane.
  void cut(const VoxelRecord& piece, int axis) const {
    const auto begin = order.begin() + piece.first;
    const auto end = begin + piece.count;
    if (piece.count <= kLeastCut) {
      std::sort(begin, end);
      return;
    }
    const std::uint32_t slot = cut_slot(piece), left = slot - piece.first;
    std::nth_element(begin, begin + left, end, [&](std::uint32_t a, std::uint32_t b) {
      return at(a, axis) < at(b, axis) || (at(a, axis) == at(b, axis) && a < b);
    });
    planes[cut_index(slot)] = at(order[slot], axis);
    cut({piece.first, left}, (axis + 1) % 3);
    cut({slot, piece.count - left}, (axis + 1) % 3);
  }
};

}  // namespace

int cell_of(float coordinate, float voxel_size) {
  const double cell = std::floor(static_cast<double>(coordinate) / voxel_size);
  return static_cast<int>(std::clamp(cell, -1073741824.0, 1073741824.0));
}

std::vector<std::uint32_t> stored_gaussians(const ActivatedCloud& cloud, Stored stored) {
  std::vector<std::uint32_t> kept;
  kept.reserve(cloud.size());
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    if (stored == Stored::kAll || visible_cutoff(cloud.gaussians[i].opacity) >= 0) {
      kept.push_back(i);
    }
  }
  return kept;
}

Arrangement<VoxelGrid> arrange_by_voxels(const ActivatedCloud& cloud, float voxel_size,
                                         Stored stored) {
  Arrangement<VoxelGrid> out;
  VoxelGrid& grid = out.table;
  grid.frame.voxel_size = voxel_size;
  const std::vector<std::uint32_t> kept = stored_gaussians(cloud, stored);
  if (kept.empty()) return out;
  grid.frame = fit_frame(cloud, kept, voxel_size);

  std::vector<std::pair<std::uint64_t, std::uint32_t>> keyed(kept.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, kept.size(), 8192), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      glm::ivec3 cell;
      for (int axis = 0; axis < 3; ++axis) {
        cell[axis] =
            cell_of(cloud.gaussians[kept[i]].mean[axis], voxel_size) - grid.frame.origin_cell[axis];
      }
      keyed[i] = {morton(cell), kept[i]};
    }
  });
  tbb::parallel_sort(keyed.begin(), keyed.end());

  std::vector<std::uint64_t> codes;
  out.storage_order.reserve(keyed.size());
  for (const auto& [code, index] : keyed) {
    if (codes.empty() || codes.back() != code) {
      codes.push_back(code);
      grid.voxels.push_back({static_cast<std::uint32_t>(out.storage_order.size()), 0});
    }
    ++grid.voxels.back().count;
    out.storage_order.push_back(index);
  }

  grid.cuts = cut_voxels(cloud, grid.voxels, out.storage_order);

  // Levels bottom up, stored top down: the base of each level is known once all are counted.
  std::vector<std::vector<VoxelNode>> levels;
  for (int level = 0; level < grid.frame.levels; ++level) levels.push_back(build_parents(codes));
  for (std::size_t level = levels.size(); level-- > 0;) {
    const auto base = static_cast<std::uint32_t>(grid.nodes.size() + levels[level].size());
    for (VoxelNode node : levels[level]) {
      if (level > 0) node.first_child += base;
      grid.nodes.push_back(node);
    }
  }
  return out;
}

float inner_extent(const ActivatedCloud& cloud) {
  if (cloud.size() == 0) return 0;
  float longest = 0;
  std::vector<float> along(cloud.size());
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < along.size(); ++i) along[i] = cloud.gaussians[i].mean[axis];
    const auto quantile = [&](double fraction) {
      const auto at = along.begin() +
                      static_cast<std::ptrdiff_t>(fraction * static_cast<double>(along.size() - 1));
      std::nth_element(along.begin(), at, along.end());
      return *at;
    };
    const float low = quantile(0.001), high = quantile(0.999);
    longest = std::max(longest, high - low);
  }
  return longest;
}

double paper_voxel_size(float inner_extent) {
  return inner_extent > kSmallSceneExtent ? kRealVoxelSize : kSmallVoxelSize;
}

std::vector<float> cut_voxels(const ActivatedCloud& cloud, const std::vector<VoxelRecord>& voxels,
                              std::vector<std::uint32_t>& storage_order) {
  std::vector<float> planes(cut_count(static_cast<std::uint32_t>(storage_order.size())));
  const Cutter cutter{cloud, storage_order, planes};
  constexpr std::size_t kGrain = 64;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, voxels.size(), kGrain),
                    [&](const auto& range) {
                      for (std::size_t v = range.begin(); v != range.end(); ++v) {
                        cutter.cut(voxels[v], 0);
                      }
                    });
  return planes;
}

}  // namespace sgs
