// Parameters of the sorting units.
#pragma once

#include <algorithm>
#include <cstdint>

#include "modules/config/config_visitor.h"

namespace sgs {

constexpr std::uint32_t kNetworkEntries = 16;  // of a block of the network

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

  // Two runs are merged with two blocks of each; and a block of the network lies there.
  std::uint32_t least_of_runs() const { return 4 * spill_block_entries; }
  std::uint32_t least_buffer_entries() const { return std::max(kNetworkEntries, least_of_runs()); }
};

void visit(ConfigVisitor& v, SortingNetworkConfig& config);
void visit(ConfigVisitor& v, PaperSorterConfig& config);

}  // namespace sgs
