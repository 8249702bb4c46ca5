// Keys of one hierarchical filtering unit.
#pragma once

#include <cstdint>

#include "modules/config/config_visitor.h"

namespace sgs {

// Multiply-accumulates of a coarse and of a fine test that the paper states.
constexpr std::uint32_t kPaperCfuMacs = 55;
constexpr std::uint32_t kPaperFfuMacs = 427;

// Source of the multiply-accumulates of a test: cfu_macs and ffu_macs as given, the paper's where
// they are not; or counted, as our filters execute them on the scene
// (modules/streaminggs/filter_cost.h).
enum class FilterCost { kPaper, kCounted };

struct HfuConfig {
  std::uint32_t eyes = 1;  // a key of the machine of exact order
  FilterCost cost = FilterCost::kCounted;
  std::uint32_t cfus = 4;
  std::uint32_t cfu_macs = 0;
  std::uint32_t cfu_lanes = 4;
  std::uint32_t cfu_depth_cycles = 0;
  std::uint32_t ffus = 1;
  std::uint32_t ffu_macs = 0;
  std::uint32_t ffu_lanes = 16;
  std::uint32_t ffu_depth_cycles = 0;
  bool coarse_filter = true;
  std::uint32_t input_slots = 2;
  std::uint32_t slice_gaussians = 128;
  std::uint32_t candidate_fifo_entries = 16;
  std::uint32_t second_half_slots = 6;

  // Cycles that the lanes of a filter are busy with one test; its Gaussians are so far apart.
  static std::uint32_t lane_cycles(std::uint32_t macs, std::uint32_t lanes) {
    return (macs + lanes - 1) / lanes;
  }
  std::uint32_t cfu_interval_cycles() const { return lane_cycles(cfu_macs, cfu_lanes); }
  std::uint32_t ffu_interval_cycles() const { return lane_cycles(ffu_macs, ffu_lanes); }
};

inline void visit(ConfigVisitor& v, HfuConfig& c) {
  v("cost", c.cost,
    names<FilterCost>({{"paper", FilterCost::kPaper}, {"counted", FilterCost::kCounted}}),
    "of a test: cfu_macs and ffu_macs, 55 and 427 where they are 0, or as counted on our filters");
  v("cfus", c.cfus, in_range(1, 64), "coarse filters in one HFU");
  v("cfu_macs", c.cfu_macs, in_range(0, 10000),
    "multiply-accumulates of a coarse test; 0: by hfu.cost");
  v("cfu_lanes", c.cfu_lanes, in_range(1, 10000), "MAC lanes of one CFU");
  v("cfu_depth_cycles", c.cfu_depth_cycles, in_range(0, 10000),
    "latency of a coarse test; 0: by its schedule");
  v("ffus", c.ffus, in_range(1, 64), "fine filters in one HFU, behind one fetch and one decoder");
  v("ffu_macs", c.ffu_macs, in_range(0, 10000),
    "multiply-accumulates of a fine test; 0: by hfu.cost");
  v("ffu_lanes", c.ffu_lanes, in_range(1, 10000), "MAC lanes of one FFU");
  v("ffu_depth_cycles", c.ffu_depth_cycles, in_range(0, 10000),
    "latency of a fine test; 0: by its schedule");
  v("coarse_filter", c.coarse_filter, "off: every Gaussian goes to the fine filter");
  v("input_slots", c.input_slots, in_range(2, 1024), "slices in an HFU's input buffer");
  v("slice_gaussians", c.slice_gaussians, in_range(2, 1 << 20), "first halves in one slice");
  v("candidate_fifo_entries", c.candidate_fifo_entries, in_range(1, 4096),
    "from coarse to fine, with what is under test");
  v("second_half_slots", c.second_half_slots, in_range(1, 1024),
    "second halves on their way or waiting");
}

// HFUs that share a fetch, at most: parts of a group are told by the bits of a word.
constexpr std::uint32_t kMostParts = 16;

}  // namespace sgs
