// Keys of the voxel sorting unit, exact order.
#pragma once

#include <cstdint>

#include "algorithm/order/chunk_walk.h"
#include "algorithm/voxel/chunk_tree.h"
#include "modules/config/config_visitor.h"
#include "modules/streaminggs/heap_ledger.h"

namespace sgs {

struct ExactVsuConfig {
  std::uint32_t upper_nodes = 24;
  std::uint32_t nodes_in_flight = 2;
  std::uint32_t test_lanes = 29;
  std::uint32_t nodes_in_test = 8;
  std::uint32_t test_depth_cycles = 0;
  std::uint32_t queue_entries = 512;
  std::uint32_t node_queue_entries = 256;
  std::uint32_t cycles_per_queue_operation = 3;

  WalkRoom walk_room() const { return {node_queue_entries, queue_entries}; }
};

inline void visit(ConfigVisitor& v, ExactVsuConfig& c) {
  v("upper_nodes", c.upper_nodes, in_range(0, 1 << 20),
    "first nodes of the chunk tree, loaded once a frame");
  v("nodes_in_flight", c.nodes_in_flight, in_range(1, 1024),
    "nodes on their way from DRAM at a time");
  v("test_lanes", c.test_lanes, in_range(1, 10000), "MAC lanes of the chunk test");
  v("nodes_in_test", c.nodes_in_test, in_range(1, 1024),
    "nodes whose children are in the test's pipeline");
  v("test_depth_cycles", c.test_depth_cycles, in_range(0, 10000),
    "latency of a chunk test; 0: by its schedule");
  v("queue_entries", c.queue_entries, in_range(kChunkNodeWidth + 1, 1 << 24),
    "chunks in the queue of the front-to-back walk");
  v("node_queue_entries", c.node_queue_entries, in_range(kChunkNodeWidth + 1, 1 << 24),
    "nodes in the queue of the front-to-back walk");
  v("cycles_per_queue_operation", c.cycles_per_queue_operation, in_range(kFewestHeapCycles, 64),
    "until the next may enter a queue's heap; 2 takes four banks a level, which read ahead, more "
    "takes two");
}

// An entry of the queue of chunks, and of either queue in DRAM: depth, place, count, walk, reach.
constexpr std::uint32_t kWalkEntryBytes = 16;
// An entry of the queue of nodes: depth, node, and in its top bit which of two walks; reach.
constexpr std::uint32_t kNodeEntryBytes = 12;

}  // namespace sgs
