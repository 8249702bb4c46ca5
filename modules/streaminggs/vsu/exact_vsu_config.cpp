// Keys of the voxel sorting unit, exact order.
#include "modules/streaminggs/vsu/exact_vsu_config.h"

#include "algorithm/voxel/chunk_node.h"
#include "modules/streaminggs/heap_ledger.h"

namespace sgs {

void visit(ConfigVisitor& v, ExactVsuConfig& c) {
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
    "until the next may enter a queue's heap");
}

}  // namespace sgs
