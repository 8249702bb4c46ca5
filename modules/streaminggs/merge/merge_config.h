// Keys of the merge unit.
#pragma once

#include <cstdint>

#include "algorithm/render/exact_renderer.h"
#include "modules/config/config_visitor.h"
#include "modules/streaminggs/heap_ledger.h"

namespace sgs {

struct MergeConfig {
  std::uint32_t entries = 512;
  OnOverflow on_overflow = OnOverflow::kSpill;
  std::uint32_t spill_runs = 8;
  std::uint32_t spill_block_entries = 8;
  std::uint32_t cycles_per_operation = 2;
  std::uint32_t latency_cycles = 2;
  std::uint32_t input_fifo_entries = 16;
  std::uint32_t output_fifo_entries = 4;
};

inline void visit(ConfigVisitor& v, MergeConfig& c) {
  v("entries", c.entries, in_range(2, 1 << 24), "keys that wait on chip");
  v("on_overflow", c.on_overflow,
    names<OnOverflow>({{"spill", OnOverflow::kSpill}, {"blend_early", OnOverflow::kBlendEarly}}),
    "when more keys wait: runs go to DRAM and the image stays exact, or it suffers");
  v("spill_runs", c.spill_runs, in_range(2, 1024), "spilled runs read back side by side");
  v("spill_block_entries", c.spill_block_entries, in_range(1, 1024),
    "keys read and written at once");
  v("cycles_per_operation", c.cycles_per_operation, in_range(kFewestHeapCycles, 16),
    "of the heap: from one insert or delete to the next; 2 takes four banks a level, which read "
    "ahead, more takes two");
  v("latency_cycles", c.latency_cycles, in_range(1, 1000),
    "of a key from a sorting unit until it may be released");
  v("input_fifo_entries", c.input_fifo_entries, in_range(1, 4096),
    "sorted keys waiting from each sorting unit");
  v("output_fifo_entries", c.output_fifo_entries, in_range(1, 4096),
    "released keys waiting for each HFU");
}

}  // namespace sgs
