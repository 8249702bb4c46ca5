// What the filters under test and their clocked references are given: visits of a small scene, as
// the units' messages and as what the references know of them.
#pragma once

#include <cstdint>
#include <vector>

#include "modules/streaminggs/hfu/fine_filter.h"
#include "testbench/units/hfu_plan.h"
#include "testbench/units/unit_bench.h"
#include "tests/modules/clocked/surroundings.h"
#include "tests/modules/streaminggs/clocked/clocked_fine_stages.h"

namespace sgs::test {

constexpr std::uint64_t kMarks = 1U << 20U;  // a mark is told by its visit behind these
constexpr std::uint32_t kCandidateEntries = 4;
inline std::uint64_t last_of(const tb::HfuPlan& plan) { return kMarks + plan.shares.back().visit; }

// How input, output and rendering keep a filter waiting.
struct Waits {
  std::uint32_t in_one_in = 1, in_longest = 1;
  std::uint32_t out_one_in = 1, out_longest = 1;
  Finishing finishing = {};
  Pace in(std::uint64_t seed) const { return {seed, in_one_in, in_longest}; }
  Pace out(std::uint64_t seed) const { return {seed + 1000, out_one_in, out_longest}; }
};

// Three groups side by side.
tb::SceneShape shape_of(const PixelSize& group);

// Of so many records.
ClockedTransfer read_of(const RecordArray& records, std::uint32_t first, std::size_t count);

// Of what is handed on, marks alone: what else of a finished group comes hangs on a cycle.
Takings only_marks(const Takings& all);

// Visits of so many Gaussians of the scene's first 1000 each, one behind the other, to a fine
// filter.
tb::HfuPlan fine_plan(const tb::SceneShape& shape, const FineHardware& hardware,
                      std::uint32_t visit_gaussians, std::uint64_t seed);
std::vector<FineCandidate> candidates_of(const tb::HfuPlan& plan);
std::vector<FineItem> clocked_candidates(const tb::HfuPlan& plan);
std::uint64_t what_of_splat(const SplatToken& token);

}  // namespace sgs::test
