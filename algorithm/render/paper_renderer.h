// Streaming renderer in paper order: the golden image of the accelerator (StreamingGS, DAC 2025).
// Group by group, voxels in topological order of the rays, coarse filter, fine filter, sort inside
// the voxel, blend. Across voxels nothing is corrected: what that loses is counted.
#pragma once

#include <cstdint>

#include "algorithm/order/group_visits.h"
#include "algorithm/render/render_result.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/splat/view.h"
#include "algorithm/voxel/voxel_grid.h"

namespace sgs {

struct PaperOrderConfig {
  int group_px = 64;             // side of a pixel group, a multiple of 4
  float sample_step_voxels = 0;  // 0: exact traversal of every cell; else the distance of samples
  glm::vec3 background{0.0F};
};

struct StreamingStats {
  std::uint64_t groups = 0;
  std::uint64_t visits = 0;            // (group, voxel) pairs streamed
  std::uint64_t visits_saturated = 0;  // left out because the group was finished
  std::uint64_t first_halves = 0;      // Gaussians seen by the coarse filter
  std::uint64_t second_halves = 0;     // that passed it: seen by the fine filter
  std::uint64_t splats = 0;            // that passed both: sorted and blended
  std::uint64_t subtile_blends = 0;    // (splat, 4x4 sub-tile) pairs
  std::uint64_t contributors = 0;      // (splat, pixel) blends
  std::uint64_t misordered = 0;        // blends behind a splat that is farther, at the same pixel
  std::uint64_t contributing = 0;      // Gaussians blended into at least one pixel of the frame
  std::uint64_t voxels_visited = 0;    // by at least one group
  std::uint64_t missed = 0;            // (group, splat) pairs that touch, in a voxel never visited
  std::uint64_t ray_steps = 0;
  std::uint64_t edges_offered = 0;
  std::uint64_t table_bytes_max = 0;   // ordering table of the worst group
  std::uint64_t visit_splats_max = 0;  // longest list that one visit sorts

  StreamingStats& operator+=(const StreamingStats& other);
};

struct StreamingResult {
  RenderResult frame;
  StreamingStats stats;
};

// grid: of this cloud. Deterministic whatever the number of threads.
StreamingResult render_paper_order(const View<float>& view, const ActivatedCloud& cloud,
                                   const VoxelGrid& grid, const PaperOrderConfig& config);

// Visits of one group from a grid in memory, the same that VSU derives from its table in DRAM.
GroupVisits paper_visits(const View<float>& view, const PixelRect& group, const VoxelGrid& grid,
                         float sample_step_voxels, OrderingTable& table);

}  // namespace sgs
