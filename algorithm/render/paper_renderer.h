// Streaming renderer in paper order: the golden image of the accelerator (StreamingGS, DAC 2025).
// Group by group, voxels in topological order of the rays, coarse filter, fine filter, sort inside
// the voxel, blend. Across voxels nothing is corrected: what that loses is counted.
#pragma once

#include <cstdint>
#include <vector>

#include "algorithm/memory/number_format.h"
#include "algorithm/order/group_visits.h"
#include "algorithm/render/group_state.h"
#include "algorithm/render/render_result.h"
#include "algorithm/splat/blend.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/splat/rects.h"
#include "algorithm/splat/view.h"
#include "algorithm/voxel/voxel_grid.h"

namespace sgs {

struct PaperOrderConfig {
  PixelSize group = square_of(64);  // pixels rendered together, multiples of 4
  bool coarse_filter = true;        // off: every Gaussian of a voxel goes to the fine filter
  RayPattern rays;
  // Ordering table of one group: where it is full the group is ordered in passes.
  std::uint64_t table_bytes = OrderingTable::kUnlimited;
  std::uint32_t line_destinations = 0;  // edges in lines of an adjacency table, as OrderingTable's
  // Voxels with more Gaussians are cut (voxel_grid.h), each piece a visit of its own; 0: never.
  std::uint32_t visit_gaussians = 0;
  // Parts of a group, each filtered and blended by itself (group_shape.h): a square number, and
  // the group's sides multiples of 4 times its root. In
  // single precision the pixels are the same for any. In half they are not: rounded, alpha passes
  // 1/255 some hundredths of a pixel beyond the ellipse, and a splat that reaches a part only so is
  // dropped by that part's fine filter, where the filter of the whole group lets it through.
  std::uint32_t parts = 1;
  NumberFormat splats = NumberFormat::kSingle;         // between filtering and blending
  BlendPrecision precision = BlendPrecision::kSingle;  // precision of blending and of the pixels
  SubtileTest subtile_test = SubtileTest::kEllipse;
  glm::vec3 background{0.0F};
};

// grid: of this cloud, which is in storage order. Deterministic whatever the number of threads.
StreamingResult render_paper_order(const View<float>& view, const ActivatedCloud& cloud,
                                   const VoxelGrid& grid, const PaperOrderConfig& config);

// Visits of one group from a grid in memory, the same that VSU derives from its table in DRAM.
GroupVisits paper_visits(const View<float>& view, const PixelRect& group, const VoxelGrid& grid,
                         const RayPattern& rays, OrderingTable& table);

// [group] the voxels of all groups' visits, as in StreamingResult. They follow from the grid alone.
std::vector<std::vector<std::uint32_t>> visited_voxels(const View<float>& view,
                                                       const VoxelGrid& grid,
                                                       const PaperOrderConfig& config);

}  // namespace sgs
