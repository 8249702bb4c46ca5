// The inputs of a voxel sorting unit in exact order, and its expected outputs.
#pragma once

#include <cstdint>
#include <vector>

#include "algorithm/storage/encoded_cloud.h"
#include "algorithm/voxel/chunk_tree.h"
#include "modules/streaminggs/vsu/exact_vsu.h"
#include "testbench/units/random_scene.h"

namespace sgs::tb {

struct ExactVsuPlan {
  ExactVsuConfig config;
  ChunkTree tree;
  MemoryImage image;
  StreamingJob job;
  std::uint32_t hfus = 4;
  std::uint32_t fifo_entries = kVisitFifoEntries;
  std::uint32_t feedback_cycles = 1;
  int saturate_one_in = 0;          // 0: never; else how often a reader reports a group as finished
  bool finished_before = false;     // all groups are reported before the first visit
  std::uint64_t hfus_begin_at = 0;  // cycle before which they take nothing
  bool reads_overlap = false;       // most of their latency is hidden
  int finished_columns = 0;  // sub-tile columns of each group, from the left, from the start on
};

// Chunks of at most so many Gaussians.
ExactVsuPlan plan_of(const TestScene& scene, std::uint32_t chunk);

std::uint64_t macs_of_a_test();
std::uint64_t comparisons_of_a_test();

struct ExpectedWalk {
  std::vector<std::vector<WalkEntry>> groups;  // chunks in order
  std::vector<std::uint64_t> nodes_of;         // [group] opened
  std::uint64_t nodes = 0, upper = 0;          // opened; of these kept on chip
  std::uint64_t tests = 0, testing_cycles = 0, turn_cycles = 0, cycles = 0, empty = 0, visits = 0,
                queue_operations = 0;
  std::uint64_t nodes_hidden = 0, chunks_hidden = 0;  // behind finished columns
};

// All chunks below nodes that touch a group, sorted, and what the nodes cost.
ExpectedWalk expect(const ExactVsuPlan& plan);

}  // namespace sgs::tb
