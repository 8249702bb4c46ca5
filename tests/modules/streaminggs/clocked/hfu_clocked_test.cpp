// Coarse and fine filter against their clocked references.
#include <catch2/catch.hpp>

#include "algorithm/memory/first_half_test.h"
#include "modules/streaminggs/hfu/coarse_filter.h"
#include "modules/streaminggs/hfu/fine_filter.h"
#include "tests/modules/clocked/comparison.h"
#include "tests/modules/streaminggs/clocked/clocked_coarse_filter.h"
#include "tests/modules/streaminggs/clocked/clocked_fine_filter.h"
#include "tests/modules/streaminggs/clocked/hfu_workloads.h"

namespace sgs::test {
namespace {

// Visits of so many Gaussians each, as of the preset `exact` where nothing else is said.
struct CoarseWorkload {
  const char* name;
  std::uint32_t most = 16;
  Waits waits;
  CoarseHardware hardware;
};

tb::HfuPlan coarse_plan(const CoarseWorkload& load, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  tb::HfuPlan plan = tb::hfu_plan_of(tb::random_scene(random, shape_of()));
  plan.config.cfus = load.hardware.cfus;
  plan.config.cfu_macs = 2 * load.hardware.test_cycles;
  plan.config.cfu_lanes = 2;
  plan.config.cfu_depth_cycles = load.hardware.depth_cycles;
  plan.config.slice_gaussians = load.hardware.slice_gaussians;
  plan.config.input_slots = load.hardware.input_slots;
  plan.config.candidate_fifo_entries = load.hardware.output_entries;
  plan.scene.job.groups.resize(1);
  plan.scene.job.parts = {plan.scene.job.groups};
  tb::add_shares(random, plan, 60, load.most);
  return plan;
}

std::vector<CoarseShare> clocked_shares(const tb::HfuPlan& plan) {
  std::vector<CoarseShare> shares;
  const SceneLayout& layout = plan.scene.job.layout;
  for (const VisitShare& share : plan.shares) {
    CoarseShare clocked;
    clocked.mark = kMarks + share.visit;
    for (std::uint32_t slot = share.first; slot < share.first + share.count; ++slot) {
      clocked.what.push_back(slot);
      const SplitFirstHalf first =
          read_first_half(layout.split, plan.scene.image.at(layout.first_halves.address(slot)));
      clocked.passes.push_back(touches(bound_first_half(layout.split, first, plan.scene.job.view),
                                       plan.scene.job.groups[share.group]));
    }
    for (std::uint32_t at = 0; at < share.count; at += plan.config.slice_gaussians) {
      clocked.transactions.push_back(
          transactions(layout.first_halves, share.first + at,
                       std::min(plan.config.slice_gaussians, share.count - at)));
    }
    shares.push_back(std::move(clocked));
  }
  return shares;
}

std::uint64_t what_of(const FineCandidate& c) {
  return c.mark == Mark::kNone ? c.slot : kMarks + c.visit;
}

void run_coarse(tb::Case& test, Takings& taken, const CoarseWorkload& load, std::uint64_t seed) {
  const tb::HfuPlan plan = coarse_plan(load, seed);
  tb::UnitBench bench(test, bench_of(plan, load.waits));
  bench.load(0, plan.scene.image.bytes);
  FinishedGroups finished("finished", bench.clock(), 1, 1);
  auto& in = bench.add_fifo<VisitShare>("shares", kVisitFifoEntries, 1);
  auto& out = bench.add_fifo<FineCandidate>("keys", plan.config.candidate_fifo_entries,
                                            plan.config.cfu_depth_cycles);
  CoarseFilter unit("coarse", plan.config, bench.context(plan.scene.job));
  unit.shares(in);
  unit.survivors(out);
  unit.finished(finished);
  bench.add_unit(unit);
  std::size_t items = 0;
  for (const CoarseShare& share : clocked_shares(plan)) {
    items +=
        1 + static_cast<std::size_t>(std::count(share.passes.begin(), share.passes.end(), true));
  }
  add_source(bench, "vsu", plan.shares, load.waits.in(seed), in);
  add_sink(bench, "sorter", items, load.waits.out(seed), out, taken, what_of);
  bench.run();
}

Takings clocked_coarse(const CoarseWorkload& load, std::uint64_t seed) {
  const tb::HfuPlan plan = coarse_plan(load, seed);
  CoarseHardware hardware = load.hardware;
  hardware.memory_latency = load.waits.memory_latency;
  ClockedCoarseFilter unit(hardware);
  ClockedFifo<CoarseShare> in(kVisitFifoEntries);
  ClockedSource<CoarseShare> source(clocked_shares(plan), load.waits.in(seed));
  ClockedSink<std::uint64_t> sink(load.waits.out(seed));
  const std::uint64_t last = kMarks + plan.shares.back().visit;
  for (std::uint64_t now = 0; sink.taken().empty() || sink.taken().back().what != last; ++now) {
    unit.step_results();
    sink.step(unit.out, now);
    unit.step(in);
    source.step(in);
    in.step();
  }
  return sink.taken();
}

TEST_CASE("clocked reference: coarse filter") {
  Comparison table("coarse filter");
  const CoarseHardware exact;
  const CoarseHardware paper{4, 14, 99, 128, 2, 10, 0};
  CoarseHardware tiny = exact;
  tiny.slice_gaussians = 2;
  tiny.input_slots = 1;
  tiny.output_entries = 2;
  for (const CoarseWorkload& load : {
           CoarseWorkload{"light: visits of up to 3", 3, {}, exact},
           CoarseWorkload{"heavy: visits of up to 16", 16, {}, exact},
           CoarseWorkload{"input stalled", 16, {2, 600}, exact},
           CoarseWorkload{"output stalled", 16, {1, 1, 4, 200}, exact},
           CoarseWorkload{"memory of 300 cycles", 16, {1, 1, 1, 1, 300}, exact},
           CoarseWorkload{"tiny buffers", 16, {}, tiny},
           CoarseWorkload{"tiny buffers, output stalled", 16, {1, 1, 4, 200}, tiny},
           CoarseWorkload{"as of paper, visits of up to 256", 256, {}, paper},
           CoarseWorkload{"as of paper, output stalled", 256, {1, 1, 4, 60}, paper},
       }) {
    table.workload(load, run_coarse, clocked_coarse);
  }
}

// Candidates one behind the other, a mark behind every so many.
struct FineWorkload {
  const char* name;
  std::uint32_t visit = 50;  // candidates
  Rejects rejects = Rejects::kReported;
  Waits waits;
  FineHardware hardware;
};

tb::HfuPlan plan_of(const FineWorkload& load, std::uint64_t seed) {
  return fine_plan(shape_of(), load.hardware, load.visit, seed);
}

void run_fine(tb::Case& test, Takings& taken, const FineWorkload& load, std::uint64_t seed) {
  const tb::HfuPlan plan = plan_of(load, seed);
  tb::UnitBench bench(test, bench_of(plan, load.waits));
  bench.load(0, plan.scene.image.bytes);
  FinishedGroups finished("finished", bench.clock(), 1, 1);
  auto& in = bench.add_fifo<FineCandidate>("candidates", kCandidateEntries, 1);
  auto& out = bench.add_fifo<SplatToken>("splats", load.hardware.output_entries,
                                         plan.config.ffu_depth_cycles);
  FineFilter unit("fine", plan.config, plan.codebook, {0, load.rejects},
                  bench.context(plan.scene.job));
  unit.candidates(in);
  unit.splats(out);
  unit.finished(finished);
  bench.add_unit(unit);
  std::size_t items = 0;
  for (const FineItem& item : clocked_candidates(plan, load.rejects)) items += item.passes ? 1 : 0;
  add_source(bench, "before", candidates_of(plan), load.waits.in(seed), in);
  add_sink(bench, "behind", items, load.waits.out(seed), out, taken, what_of_splat);
  bench.run();
}

Takings clocked_fine(const FineWorkload& load, std::uint64_t seed) {
  const tb::HfuPlan plan = plan_of(load, seed);
  FineHardware hardware = load.hardware;
  hardware.memory_latency = load.waits.memory_latency;
  hardware.read_cycles = (plan.scene.job.layout.second_halves.record_bytes + 31) / 32;
  ClockedFineFilter unit(hardware);
  ClockedFifo<FineItem> in(kCandidateEntries);
  ClockedSource<FineItem> source(clocked_candidates(plan, load.rejects), load.waits.in(seed));
  ClockedSink<std::uint64_t> sink(load.waits.out(seed));
  const std::uint64_t last = kMarks + plan.shares.back().visit;
  for (std::uint64_t now = 0; sink.taken().empty() || sink.taken().back().what != last; ++now) {
    unit.step_results();
    sink.step(unit.out(), now);
    unit.step(in);
    source.step(in);
    in.step();
  }
  return sink.taken();
}

TEST_CASE("clocked reference: fine filter") {
  Comparison table("fine filter");
  const FineHardware exact;
  const FineHardware paper{6, 27, 176, 7, 7, 0};
  FineHardware tiny = exact;
  tiny.slots = 1;
  tiny.output_entries = 2;
  const Rejects told = Rejects::kReported, dropped = Rejects::kDropped;
  for (const FineWorkload& load : {
           FineWorkload{"light", 1000, told, {2, 300}, exact},
           FineWorkload{"heavy", 1000, told, {}, exact},
           FineWorkload{"a group of 50", 50, told, {}, exact},
           FineWorkload{"output stalled", 1000, told, {1, 1, 4, 200}, exact},
           FineWorkload{"memory of 300 cycles", 1000, told, {1, 1, 1, 1, 300}, exact},
           FineWorkload{"tiny buffers", 1000, told, {}, tiny},
           FineWorkload{"as of paper, visits of 5", 5, dropped, {}, paper},
           FineWorkload{"as of paper, visits of 50", 50, dropped, {}, paper},
           FineWorkload{"as of paper, output stalled", 50, dropped, {1, 1, 4, 200}, paper},
       }) {
    table.workload(load, run_fine, clocked_fine);
  }
}

}  // namespace
}  // namespace sgs::test
