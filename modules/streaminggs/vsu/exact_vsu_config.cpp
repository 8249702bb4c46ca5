// Keys of the voxel sorting unit, exact order.
#include "modules/streaminggs/vsu/exact_vsu_config.h"

#include "algorithm/voxel/chunk_node.h"

namespace sgs {

void visit(ConfigVisitor& v, ExactVsuConfig& c) {
  v("node_cache_bytes", c.node_cache_bytes, in_range(64, 1 << 30), "cache of tree nodes");
  v("test_lanes", c.test_lanes, in_range(1, 10000), "MAC lanes of the chunk test");
  v("queue_entries", c.queue_entries, in_range(kChunkNodeWidth + 1, 1 << 24),
    "queue of the front-to-back walk");
}

}  // namespace sgs
