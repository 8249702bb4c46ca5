// The inputs of an HFU under test, shares of visits of a scene, and its expected outputs.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "modules/streaminggs/hfu/codebook_config.h"
#include "modules/streaminggs/hfu/hfu_config.h"
#include "modules/streaminggs/messages.h"
#include "testbench/units/random_scene.h"

namespace sgs::tb {

// Tests of the paper's cost and pipelines of some depth, which nobody has derived here.
inline HfuConfig resolved(HfuConfig config) {
  config.cfu_macs = kPaperCfuMacs;
  config.ffu_macs = kPaperFfuMacs;
  config.cfu_depth_cycles = 12;
  config.ffu_depth_cycles = 40;
  return config;
}

struct HfuPlan {
  HfuConfig config = resolved({});
  CodebookConfig codebook;
  TestScene scene;
  std::vector<VisitShare> shares;
  std::uint32_t sorting_units = 2;
  std::uint32_t output_entries = 4096;
  std::uint32_t feedback_cycles = 1;
  int saturate_one_in = 0;  // 0: never; else how often a reader reports a group as finished
  std::vector<std::uint64_t> finish_cycles;  // [group] when it is reported; empty: none is
};

// The expected outcome of one share, slot by slot.
struct ExpectedShare {
  std::vector<bool> passes;          // coarse filter
  std::vector<std::uint32_t> lines;  // lines of the codebook buffer, for each Gaussian's record
  std::vector<Splat> splats;
};

// By the filters' functions, on what the bytes in memory decode to.
ExpectedShare expect(const HfuPlan& plan, const VisitShare& share);

HfuPlan hfu_plan_of(TestScene scene);

// `visits` shares of random slots for each group, then the group's end.
void add_shares(std::mt19937_64& random, HfuPlan& plan, std::size_t visits, std::uint32_t most);

}  // namespace sgs::tb
