// Parameters of the merge unit.
#pragma once

#include <cstdint>

#include "algorithm/order/on_overflow.h"
#include "modules/config/config_visitor.h"

namespace sgs {

struct MergeConfig {
  std::uint32_t entries = 1660;  // keys that wait on chip
  OnOverflow on_overflow = OnOverflow::kSpill;
  std::uint32_t spill_runs = 8;           // runs in DRAM that are read back side by side
  std::uint32_t spill_block_entries = 8;  // keys read and written at once: 256 B
  std::uint32_t latency_cycles = 12;      // through the levels of the pipelined heap
  std::uint32_t input_fifo_entries = 16;  // sorted keys waiting, from each sorting unit
  std::uint32_t output_fifo_entries = 4;  // released keys waiting, for each HFU
};

void visit(ConfigVisitor& v, MergeConfig& config);

// While it waits, and in DRAM, a key has room for the Gaussian's index in the file.
constexpr std::uint32_t kWaitingKeyBytes = 32;
constexpr std::uint32_t kSpilledKeyBytes = 32;

}  // namespace sgs
