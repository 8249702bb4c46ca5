// Parameters of one hierarchical filtering unit.
#pragma once

#include <cstdint>

#include "modules/config/config_visitor.h"

namespace sgs {

// Multiply-accumulates of a coarse and of a fine test that the paper states.
constexpr std::uint32_t kPaperCfuMacs = 55;
constexpr std::uint32_t kPaperFfuMacs = 427;

// Which multiply-accumulates a test costs: cfu_macs and ffu_macs as they are given, the paper's
// where they are not, or those that our filters execute on the scene
// (modules/streaminggs/filter_cost.h).
enum class FilterCost { kPaper, kCounted };

struct HfuConfig {
  FilterCost cost = FilterCost::kCounted;
  std::uint32_t cfus = 4;              // coarse filters in one HFU
  std::uint32_t cfu_macs = 0;          // of a test; 0: as `cost` says
  std::uint32_t cfu_lanes = 4;         // MAC lanes of one CFU
  std::uint32_t cfu_depth_cycles = 0;  // from a test's beginning to its end; 0: by its schedule
  std::uint32_t ffu_macs = 0;          // likewise
  std::uint32_t ffu_lanes = 16;
  std::uint32_t ffu_depth_cycles = 0;         // likewise
  bool coarse_filter = true;                  // off: every Gaussian goes to the fine filter
  std::uint32_t input_slots = 2;              // slices in the input buffer: fetched and filtered
  std::uint32_t slice_gaussians = 128;        // first halves in one half of the input buffer
  std::uint32_t candidate_fifo_entries = 16;  // coarse -> fine, with what is under test
  std::uint32_t second_half_slots = 6;        // second halves on their way or waiting

  // Cycles that the lanes of a filter are busy with one test; its Gaussians are so far apart.
  static std::uint32_t lane_cycles(std::uint32_t macs, std::uint32_t lanes) {
    return (macs + lanes - 1) / lanes;
  }
  std::uint32_t cfu_interval_cycles() const { return lane_cycles(cfu_macs, cfu_lanes); }
  std::uint32_t ffu_interval_cycles() const { return lane_cycles(ffu_macs, ffu_lanes); }
};

void visit(ConfigVisitor& v, HfuConfig& config);

// HFUs that share a fetch, at most: parts of a group are told by the bits of a word.
constexpr std::uint32_t kMostParts = 16;

}  // namespace sgs
