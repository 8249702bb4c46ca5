// Parameters of the merge unit.
#pragma once

#include <cstdint>

#include "algorithm/render/exact_renderer.h"
#include "modules/config/config_visitor.h"

namespace sgs {

struct MergeConfig {
  std::uint32_t entries = 512;  // keys that wait on chip
  OnOverflow on_overflow = OnOverflow::kSpill;
  std::uint32_t spill_runs = 8;           // runs in DRAM that are read back side by side
  std::uint32_t spill_block_entries = 8;  // keys read and written at once: 256 B
  // Of the heap, from one insert or delete to the next. 2: four banks a level, which read ahead; 3
  // and more: two (../../../algorithm/order/interval_heap.h).
  std::uint32_t cycles_per_operation = 2;
  std::uint32_t latency_cycles = 2;       // of a key from sorting until it may be released
  std::uint32_t input_fifo_entries = 16;  // sorted keys waiting, from each sorting unit
  std::uint32_t output_fifo_entries = 4;  // released keys waiting, for each HFU
};

void visit(ConfigVisitor& v, MergeConfig& config);

}  // namespace sgs
