// Parameters of the sorting units.
#pragma once

#include <cstdint>

#include "modules/config/config_visitor.h"

namespace sgs {

// The network, the same in both orders.
struct SortingNetworkConfig {
  std::uint32_t sort_interval_cycles = 1;   // between two 16-entry blocks into the bitonic network
  std::uint32_t sort_latency_cycles = 12;   // its 10 compare-exchange stages, in and out
  std::uint32_t merge_interval_cycles = 2;  // between two merges of 8 + 8 entries (4 stages)
  bool skip_trivial = true;                 // a list of one entry is not sent through the network
};

struct PaperSorterConfig : SortingNetworkConfig {
  std::uint32_t buffer_entries = 256;     // splats on chip; longer lists spill sorted runs to DRAM
  std::uint32_t input_fifo_entries = 7;   // from each HFU: as many as its FFU has under way
  std::uint32_t spill_block_entries = 4;  // read and written at once: 192 B
};

void visit(ConfigVisitor& v, SortingNetworkConfig& config);
void visit(ConfigVisitor& v, PaperSorterConfig& config);

}  // namespace sgs
