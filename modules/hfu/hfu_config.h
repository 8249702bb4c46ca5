// Parameters of one hierarchical filtering unit.
#pragma once

#include <cstdint>

namespace sgs {

struct HfuConfig {
  std::uint32_t cfus = 4;               // coarse filters in one HFU
  std::uint32_t cfu_macs = 55;          // multiply-accumulates of one coarse test (the paper)
  std::uint32_t cfu_lanes = 4;          // MAC lanes of one CFU
  std::uint32_t cfu_depth_cycles = 12;  // latency, apart from the initiation interval
  std::uint32_t ffu_macs = 427;         // of one fine test, with projection and colour
  std::uint32_t ffu_lanes = 16;
  std::uint32_t ffu_depth_cycles = 40;
  bool coarse_filter = true;                  // off: every Gaussian goes to the fine filter
  std::uint32_t input_slots = 2;              // slices in the input buffer: fetched and filtered
  std::uint32_t slice_gaussians = 128;        // first halves in one half of the input buffer
  std::uint32_t candidate_fifo_entries = 16;  // coarse -> fine
  std::uint32_t second_half_slots = 6;        // second halves on their way or waiting

  // Cycles between two Gaussians in one filter.
  std::uint32_t cfu_interval_cycles() const { return (cfu_macs + cfu_lanes - 1) / cfu_lanes; }
  std::uint32_t ffu_interval_cycles() const { return (ffu_macs + ffu_lanes - 1) / ffu_lanes; }
};

}  // namespace sgs
