// Keys of the sorting units.
#pragma once

#include <algorithm>
#include <cstdint>

#include "modules/config/config_visitor.h"

namespace sgs {

constexpr std::uint32_t kNetworkEntries = 16;  // entries in a block of the network

// The network, the same in both orders.
struct SortingNetworkConfig {
  std::uint32_t sort_interval_cycles = 1;
  std::uint32_t sort_latency_cycles = 12;
  std::uint32_t merge_interval_cycles = 2;
  bool skip_trivial = true;
};

struct PaperSorterConfig : SortingNetworkConfig {
  std::uint32_t buffer_entries = 256;
  std::uint32_t input_fifo_entries = 7;  // as many as an FFU has under way
  std::uint32_t spill_block_entries = 4;

  // Two runs are merged with two blocks of each; and a block of the network lies there.
  std::uint32_t least_of_runs() const { return 4 * spill_block_entries; }
  std::uint32_t least_buffer_entries() const { return std::max(kNetworkEntries, least_of_runs()); }
};

inline void visit(ConfigVisitor& v, SortingNetworkConfig& c) {
  v("sort_interval_cycles", c.sort_interval_cycles, in_range(1, 64), "between blocks of 16");
  v("sort_latency_cycles", c.sort_latency_cycles, in_range(1, 1000),
    "of the bitonic network: its 10 compare-exchange stages, in and out");
  v("merge_interval_cycles", c.merge_interval_cycles, in_range(1, 64), "between merges of 8 + 8");
  v("skip_trivial", c.skip_trivial, "a list of one entry is not sent through the network");
}

inline void visit(ConfigVisitor& v, PaperSorterConfig& c) {
  visit(v, static_cast<SortingNetworkConfig&>(c));
  v("buffer_entries", c.buffer_entries, in_range(kNetworkEntries, 1 << 20),
    "splats on chip in one unit; longer lists spill sorted runs to DRAM");
  v("input_fifo_entries", c.input_fifo_entries, in_range(1, 4096), "splats waiting from each HFU");
  v("spill_block_entries", c.spill_block_entries, in_range(1, 1024), "read and written at once");
}

}  // namespace sgs
