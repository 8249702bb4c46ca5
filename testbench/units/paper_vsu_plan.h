// The inputs of a voxel sorting unit in paper order, and its expected outputs.
#pragma once

#include <cstdint>
#include <vector>

#include "algorithm/order/ordering_table.h"
#include "algorithm/voxel/voxel_grid.h"
#include "modules/streaminggs/vsu/paper_vsu.h"
#include "testbench/units/random_scene.h"

namespace sgs::tb {

struct PaperVsuPlan {
  PaperVsuConfig config;
  TestScene scene;
  std::uint32_t hfus = 4;
  std::uint32_t fifo_entries = kVisitFifoEntries;
  std::uint32_t feedback_cycles = 1;
  int saturate_one_in = 0;       // 0: never; else how often a reader reports a group as finished
  bool finished_before = false;  // all groups are reported before the first visit
};

// A table that holds every group, voxels whole.
PaperVsuPlan paper_vsu_plan_of(TestScene scene);

constexpr std::uint64_t kLineBytes = 32;  // line of VSU's caches

inline std::uint64_t ceil_div(std::uint64_t a, std::uint64_t b) { return (a + b - 1) / b; }

// Multiply-accumulates.
std::uint64_t macs_of_a_step();
std::uint64_t macs_of_a_beginning();
std::uint64_t macs_of_a_sampled_beginning();
std::uint64_t macs_of_a_sample();
// Beside them.
std::uint64_t comparisons_of_a_step();
std::uint64_t comparisons_of_a_beginning();

struct ExpectedVisits {
  std::vector<std::vector<VoxelRecord>> groups;  // pieces of voxels in visiting order
  std::uint64_t cuts = 0;
  std::uint64_t lookups = 0, met = 0;
  std::uint64_t visits = 0, empty = 0, rays = 0, steps = 0, edges = 0, table_bytes_max = 0;
  std::uint64_t passes = 0, overflows = 0;
  std::vector<std::uint64_t> rays_of;  // [group]
  std::uint64_t voxels = 0;            // whole
  std::uint64_t orderings = 0;         // orderings of a table that had been filled
  OrderingAccesses table;              // accesses of passes without an overflow
};

// From the grid itself.
ExpectedVisits expect(const PaperVsuPlan& plan);

}  // namespace sgs::tb
