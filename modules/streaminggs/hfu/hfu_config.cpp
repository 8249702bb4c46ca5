// Keys of the hierarchical filtering units and of the codebook buffer.
#include "modules/streaminggs/hfu/hfu_config.h"

#include "modules/streaminggs/hfu/codebook_config.h"

namespace sgs {

void visit(ConfigVisitor& v, HfuConfig& c) {
  v("cost", c.cost,
    names<FilterCost>({{"paper", FilterCost::kPaper}, {"counted", FilterCost::kCounted}}),
    "of a test: cfu_macs and ffu_macs, 55 and 427 where they are 0, or as counted on our filters");
  v("cfus", c.cfus, in_range(1, 64), "coarse filters in one HFU");
  v("cfu_macs", c.cfu_macs, in_range(0, 10000),
    "multiply-accumulates of a coarse test; 0: by hfu.cost");
  v("cfu_lanes", c.cfu_lanes, in_range(1, 10000), "MAC lanes of one CFU");
  v("cfu_depth_cycles", c.cfu_depth_cycles, in_range(0, 10000),
    "latency of a coarse test; 0: by its schedule");
  v("ffu_macs", c.ffu_macs, in_range(0, 10000),
    "multiply-accumulates of a fine test; 0: by hfu.cost");
  v("ffu_lanes", c.ffu_lanes, in_range(1, 10000), "MAC lanes of one FFU");
  v("ffu_depth_cycles", c.ffu_depth_cycles, in_range(0, 10000),
    "latency of a fine test; 0: by its schedule");
  v("coarse_filter", c.coarse_filter, "off: every Gaussian goes to the fine filter");
  v("input_slots", c.input_slots, in_range(2, 1024), "slices in an HFU's input buffer");
  v("slice_gaussians", c.slice_gaussians, in_range(2, 1 << 20), "first halves in one slice");
  v("candidate_fifo_entries", c.candidate_fifo_entries, in_range(1, 4096), "coarse to fine");
  v("second_half_slots", c.second_half_slots, in_range(1, 1024),
    "second halves on their way or waiting");
}

void visit(ConfigVisitor& v, CodebookConfig& c) {
  v("banks", c.banks, in_range(1, 64), "of the codebook buffer, lines interleaved over them");
  v("line_bytes", c.line_bytes, in_range(4, 256), "of a bank, read in one cycle");
  v("latency_cycles", c.latency_cycles, in_range(1, 100), "from the last line to the FFU");
  v("preloaded", c.preloaded, "filled by an earlier frame: no traffic, no time");
}

}  // namespace sgs
