// Parameters of the voxel sorting unit, paper order.
#pragma once

#include <cstdint>

#include "algorithm/order/group_visits.h"
#include "modules/config/config_visitor.h"

namespace sgs {

constexpr std::uint32_t kTableWordBytes = 8;  // of the ordering table: a record

struct PaperVsuConfig {
  std::uint32_t rays_in_flight = 80;  // of a group, side by side
  std::uint32_t chain_entries = 3;    // voxels that a ray keeps until they are entered
  std::uint32_t step_lanes = 24;      // multiply-accumulates a cycle of the rays' steps
  std::uint32_t ray_lanes = 8;        // of their beginnings
  // From a step's beginning to the ray's next, and of one out of a single cell, which moves along
  // one axis only; 0: by its schedule.
  std::uint32_t step_depth_cycles = 0, cell_step_depth_cycles = 0;
  std::uint32_t ray_depth_cycles = 0;       // of a ray's beginning; 0: by its schedule
  std::uint32_t table_banks = 2;            // of the ordering table: a record of each a cycle
  std::uint32_t ray_step_px = 2;            // rays of every so-many-th pixel, and of the last ones
  double sample_step_voxels = 0;            // 0: every cell of the ray; else distance of samples
  std::uint32_t groups_ahead = 1;           // lists of ordered voxels
  std::uint32_t table_bytes = 4096;         // ordering table of one group; fuller ones take passes
  std::uint32_t node_cache_bytes = 2048;    // in front of the tree in DRAM
  std::uint32_t node_fetches = 7;           // lines of it on their way to that cache
  std::uint32_t record_cache_bytes = 1024;  // in front of the voxel records
  std::uint32_t cut_cache_bytes = 256;      // in front of the planes of cut voxels
  std::uint32_t visit_gaussians = 256;      // voxels with more are cut; 0: never
  std::uint32_t min_share = 16;             // fewest Gaussians of a visit that one HFU is given

  // From a step out of a block of 2^log2_block cells a side to the ray's next.
  std::uint32_t step_cycles(std::uint32_t log2_block) const {
    return log2_block == 0 ? cell_step_depth_cycles : step_depth_cycles;
  }
  // A word in each bank.
  std::uint32_t least_table_bytes() const { return kTableWordBytes * table_banks; }
  RayPattern rays() const {
    return {ray_step_px, static_cast<float>(sample_step_voxels), rays_in_flight};
  }
};

void visit(ConfigVisitor& v, PaperVsuConfig& config);

}  // namespace sgs
