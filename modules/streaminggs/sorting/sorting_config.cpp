// Keys of the sorting units.
#include "modules/streaminggs/sorting/sorting_config.h"

namespace sgs {

void visit(ConfigVisitor& v, SortingNetworkConfig& c) {
  v("sort_interval_cycles", c.sort_interval_cycles, in_range(1, 64), "between blocks of 16");
  v("sort_latency_cycles", c.sort_latency_cycles, in_range(1, 1000), "of the bitonic network");
  v("merge_interval_cycles", c.merge_interval_cycles, in_range(1, 64), "between merges of 8 + 8");
  v("skip_trivial", c.skip_trivial, "a list of one entry is not sent through the network");
}

void visit(ConfigVisitor& v, PaperSorterConfig& c) {
  visit(v, static_cast<SortingNetworkConfig&>(c));
  v("buffer_entries", c.buffer_entries, in_range(kNetworkEntries, 1 << 20),
    "splats on chip in one unit");
  v("input_fifo_entries", c.input_fifo_entries, in_range(1, 4096), "splats waiting from each HFU");
  v("spill_block_entries", c.spill_block_entries, in_range(1, 1024), "read and written at once");
}

}  // namespace sgs
