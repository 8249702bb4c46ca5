// Parameters of the voxel sorting unit, exact order.
#pragma once

#include <cstdint>

#include "algorithm/order/chunk_walk.h"
#include "modules/config/config_visitor.h"

namespace sgs {

struct ExactVsuConfig {
  std::uint32_t upper_nodes = 24;          // of the chunk tree, kept on chip
  std::uint32_t nodes_in_flight = 2;       // others, on their way from DRAM
  std::uint32_t test_lanes = 32;           // multiply-accumulates a cycle of the chunk test
  std::uint32_t nodes_in_test = 8;         // nodes whose children are in the test's pipeline
  std::uint32_t test_depth_cycles = 0;     // of a child, first to last; 0: by its schedule
  std::uint32_t queue_entries = 512;       // chunks in the queue of the front-to-back walk
  std::uint32_t node_queue_entries = 256;  // nodes in that of the nodes
  // Of a queue's heap, as the merge unit's: 2 would take four banks a level, which read ahead; with
  // 3 and more it has two (../heap_ledger.h).
  std::uint32_t cycles_per_queue_operation = 3;

  WalkRoom walk_room() const { return {node_queue_entries, queue_entries}; }
};

void visit(ConfigVisitor& v, ExactVsuConfig& config);

// An entry of the queue of chunks, and of either queue in DRAM: depth, place, count, walk, reach.
constexpr std::uint32_t kWalkEntryBytes = 16;
// Of the queue of nodes: depth, node, and in its top bit which of two walks; reach.
constexpr std::uint32_t kNodeEntryBytes = 12;

}  // namespace sgs
