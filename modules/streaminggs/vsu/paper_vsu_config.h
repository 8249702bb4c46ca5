// Parameters of the voxel sorting unit, paper order.
#pragma once

#include <cstdint>

#include "algorithm/order/group_visits.h"
#include "modules/config/config_visitor.h"

namespace sgs {

struct PaperVsuConfig {
  std::uint32_t step_lanes = 64;            // multiply-accumulates a cycle of the rays' steps
  std::uint32_t edges_per_cycle = 1;        // insertions into the ordering table
  std::uint32_t ray_step_px = 2;            // rays of every so-many-th pixel, and of the last ones
  double sample_step_voxels = 0;            // 0: every cell of the ray; else distance of samples
  std::uint32_t groups_ahead = 1;           // ordered groups that wait for the HFUs
  std::uint32_t table_bytes = 5312;         // ordering table of one group; fuller ones take passes
  std::uint32_t node_cache_bytes = 8192;    // in front of the tree in DRAM
  std::uint32_t record_cache_bytes = 1024;  // in front of the voxel records
  std::uint32_t cut_cache_bytes = 256;      // in front of the planes of cut voxels
  std::uint32_t visit_gaussians = 256;      // voxels with more are cut; 0: never
  std::uint32_t min_share = 16;             // fewest Gaussians of a visit that one HFU is given

  RayPattern rays() const { return {ray_step_px, static_cast<float>(sample_step_voxels)}; }
};

void visit(ConfigVisitor& v, PaperVsuConfig& config);

}  // namespace sgs
