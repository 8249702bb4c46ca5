// Keys of the voxel sorting unit, paper order.
#pragma once

#include <cstdint>

#include "algorithm/order/group_visits.h"
#include "algorithm/voxel/renaming_table.h"
#include "modules/config/config_visitor.h"

namespace sgs {

constexpr std::uint32_t kTableWordBytes = 8;  // a record of the ordering table

struct PaperVsuConfig {
  std::uint32_t rays_in_flight = 80;
  std::uint32_t chain_entries = 3;
  std::uint32_t step_lanes = 24;
  std::uint32_t ray_lanes = 8;
  std::uint32_t step_depth_cycles = 0, cell_step_depth_cycles = 0;
  std::uint32_t ray_depth_cycles = 0;
  std::uint32_t table_banks = 2;
  std::uint32_t ray_step_px = 2;
  double sample_step_voxels = 0, sample_far_voxels = 0;
  std::uint32_t samples_per_cycle = 0;
  RenamingForm renaming = RenamingForm::kHashed;
  std::uint32_t renaming_bytes = 8192;
  std::uint32_t adjacency_lines = 256, adjacency_destinations = 7;
  std::uint32_t groups_ahead = 1;
  std::uint32_t table_bytes = 4096;
  std::uint32_t node_cache_bytes = 2048;
  std::uint32_t node_fetches = 7;
  std::uint32_t record_cache_bytes = 1024;
  std::uint32_t cut_cache_bytes = 256;
  std::uint32_t visit_gaussians = 256;
  std::uint32_t min_share = 16;

  // Cycles from a step out of a block of 2^log2_block cells a side to the ray's next.
  std::uint32_t step_cycles(std::uint32_t log2_block) const {
    return log2_block == 0 ? cell_step_depth_cycles : step_depth_cycles;
  }
  // A word in each bank.
  std::uint32_t least_table_bytes() const { return kTableWordBytes * table_banks; }
  // VSU of the paper: voxels by the coordinates of samples, a renaming table, an adjacency table.
  bool samples() const { return samples_per_cycle > 0; }
  RayPattern rays() const {
    return {ray_step_px, static_cast<float>(sample_step_voxels),
            static_cast<float>(sample_far_voxels), samples() ? 1 : rays_in_flight, samples()};
  }
  // As OrderingTable's.
  std::uint32_t line_destinations() const { return samples() ? adjacency_destinations : 0; }
};

inline void visit(ConfigVisitor& v, PaperVsuConfig& c) {
  v("rays_in_flight", c.rays_in_flight, in_range(1, 1024),
    "rays that are followed side by side, or begun ahead of the one that is sampled");
  v("chain_entries", c.chain_entries, in_range(1, 1024),
    "voxels that a ray keeps until those of the rays before it are in the ordering table");
  v("step_lanes", c.step_lanes, in_range(1, 10000), "MAC lanes of the rays' steps");
  v("ray_lanes", c.ray_lanes, in_range(1, 10000), "MAC lanes of the rays' beginnings");
  v("step_depth_cycles", c.step_depth_cycles, in_range(0, 1000),
    "until a ray can step again; 0: by its schedule");
  v("cell_step_depth_cycles", c.cell_step_depth_cycles, in_range(0, 1000),
    "the same of a step out of a single cell, which moves along one axis only; 0: by its schedule");
  v("ray_depth_cycles", c.ray_depth_cycles, in_range(0, 1000),
    "until a ray that begins is there; 0: by its schedule");
  v("table_banks", c.table_banks, in_range(1, 64),
    "of the ordering table: of each a record a cycle is read and one written");
  v("ray_step_px", c.ray_step_px, in_range(1, 1024),
    "rays of every so-many-th pixel of a group are followed, and of its last row and column");
  v("sample_step_voxels", c.sample_step_voxels, in_range(0, 10),
    "distance of samples on a ray; 0: every cell is visited");
  v("sample_far_voxels", c.sample_far_voxels, in_range(0, 1e6),
    "distance from the eye at which a ray ends whose samples number voxels; 0: with the box of all "
    "voxels");
  v("samples_per_cycle", c.samples_per_cycle, in_range(0, 16),
    "samples of a ray whose voxels are numbered by their coordinates, one ray after another; 0: "
    "rays step through the tree side by side");
  v("renaming", c.renaming,
    names<RenamingForm>({{"hashed", RenamingForm::kHashed}, {"dense", RenamingForm::kDense}}),
    "table of the voxels that hold Gaussians, where samples number them: hashed, or an entry a "
    "cell");
  v("renaming_bytes", c.renaming_bytes, in_range(128, 1 << 30),
    "of it on chip; the rest is read from DRAM");
  v("adjacency_lines", c.adjacency_lines, in_range(1, 1 << 16),
    "of the adjacency table on chip, where samples number voxels; more go to DRAM");
  v("adjacency_destinations", c.adjacency_destinations, in_range(1, 31),
    "that a line holds of its source: all are compared at once");
  v("groups_ahead", c.groups_ahead, in_range(1, 64),
    "lists of ordered voxels, in the making or being handed out");
  v("table_bytes", c.table_bytes, in_range(kTableWordBytes, 1 << 30),
    "ordering table of one group; one that needs more is ordered in passes");
  v("node_cache_bytes", c.node_cache_bytes, in_range(64, 1 << 30), "cache of tree nodes");
  v("node_fetches", c.node_fetches, in_range(1, 1024),
    "lines of tree nodes on their way from DRAM");
  v("record_cache_bytes", c.record_cache_bytes, in_range(64, 1 << 30), "cache of voxel records");
  v("cut_cache_bytes", c.cut_cache_bytes, in_range(64, 1 << 30), "cache of cut voxels' planes");
  v("visit_gaussians", c.visit_gaussians, in_range(0, 1 << 30),
    "voxels with more are cut into pieces, each a visit; 0: never");
  v("min_share", c.min_share, in_range(2, 1 << 20), "fewest Gaussians of a visit for one HFU");
}

}  // namespace sgs
