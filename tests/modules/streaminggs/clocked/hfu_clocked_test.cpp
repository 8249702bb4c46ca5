// Coarse and fine filter against their clocked references.
#include <catch2/catch.hpp>

#include "algorithm/memory/record_split.h"
#include "modules/streaminggs/exact_config.h"
#include "modules/streaminggs/hfu/coarse_filter.h"
#include "modules/streaminggs/hfu/fine_filter.h"
#include "modules/streaminggs/paper_config.h"
#include "testbench/units/job_memory.h"
#include "tests/modules/clocked/comparison.h"
#include "tests/modules/streaminggs/clocked/clocked_coarse_filter.h"
#include "tests/modules/streaminggs/clocked/clocked_fine_filter.h"
#include "tests/modules/streaminggs/clocked/group_numbers_hardware.h"
#include "tests/modules/streaminggs/clocked/hfu_workloads.h"

namespace sgs::test {
namespace {

// Visits of so many Gaussians each, as of the preset `exact` where nothing else is said.
struct CoarseWorkload {
  const char* name;
  std::uint32_t most = 16;
  Waits waits;
  CoarseHardware hardware;
  PixelSize group = preset_of<ExactConfig>("exact").group;
  std::uint64_t apart = 0;  // cycles, behind news that the unit sees late
  std::size_t visits = 20;  // of a group
};

tb::HfuPlan coarse_plan(const CoarseWorkload& load, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  tb::HfuPlan plan = tb::hfu_plan_of(tb::random_scene(random, shape_of(load.group)));
  plan.config.cfus = load.hardware.cfus;
  plan.config.cfu_macs = 2 * load.hardware.test_cycles;
  plan.config.cfu_lanes = 2;
  plan.config.cfu_depth_cycles = load.hardware.depth_cycles;
  plan.config.slice_gaussians = load.hardware.slice_gaussians;
  plan.config.input_slots = load.hardware.input_slots;
  plan.config.candidate_fifo_entries = load.hardware.output_entries;
  tb::add_shares(random, plan, load.visits, load.most);
  return plan;
}

std::vector<CoarseShare> clocked_shares(const tb::HfuPlan& plan) {
  std::vector<CoarseShare> shares;
  const SceneLayout& layout = plan.scene.job.layout;
  for (const VisitShare& share : plan.shares) {
    CoarseShare clocked;
    clocked.mark = kMarks + share.visit;
    clocked.group = share.group;
    clocked.address = layout.first_halves.address(share.first);
    clocked.record_bytes = layout.first_halves.record_bytes;
    for (std::uint32_t slot = share.first; slot < share.first + share.count; ++slot) {
      clocked.what.push_back(slot);
      const SplitFirstHalf first =
          read_first_half(layout.split, plan.scene.image.at(layout.first_halves.address(slot)));
      clocked.passes.push_back(touches(bound_first_half(layout.split, first, plan.scene.job.view),
                                       plan.scene.job.groups[share.group]));
    }
    shares.push_back(std::move(clocked));
  }
  return shares;
}

std::uint64_t what_of_candidate(const FineCandidate& c) {
  return c.mark == Mark::kNone ? c.slot : kMarks + c.visit;
}

void run_coarse(tb::Case& test, Takings& taken, const CoarseWorkload& load, std::uint64_t seed) {
  const tb::HfuPlan plan = coarse_plan(load, seed);
  tb::UnitBench bench(test, bench_of(load.hardware.port, tb::memory_bytes(plan.scene.job)));
  bench.load(0, plan.scene.image.bytes);
  FinishedGroups finished("finished", bench.clock(), plan.scene.job.groups.size(), 1);
  add_finishing(bench, load.waits.finishing, plan.scene.job.groups.size(), finished);
  auto& in = bench.add_fifo<VisitShare>("shares", kVisitFifoEntries, 1);
  auto& out = bench.add_fifo<FineCandidate>("keys", plan.config.candidate_fifo_entries,
                                            plan.config.cfu_depth_cycles);
  CoarseFilter unit("coarse", plan.config, bench.context(plan.scene.job));
  unit.shares(in);
  unit.survivors(out);
  unit.finished(finished);
  bench.add_unit(unit);
  add_source(bench, "vsu", plan.shares, load.waits.in(seed), in);
  add_sink(bench, "sorter", until_taken(last_of(plan)), load.waits.out(seed), out, taken,
           what_of_candidate);
  bench.run();
  if (load.waits.finishing.pitch > 0) taken = only_marks(taken);
}

Takings clocked_coarse(const CoarseWorkload& load, std::uint64_t seed) {
  const tb::HfuPlan plan = coarse_plan(load, seed);
  ClockedCoarseFilter unit(load.hardware);
  ClockedFifo<CoarseShare> in(kVisitFifoEntries);
  ClockedSource<CoarseShare> source(clocked_shares(plan), load.waits.in(seed));
  ClockedSink<std::uint64_t> sink(load.waits.out(seed));
  const auto done = until_taken(last_of(plan));
  for (std::uint64_t now = 0; !done(sink.taken()); ++now) {
    unit.step_results();
    sink.step(unit.out, now);
    unit.step(in, [&](std::uint32_t group) { return load.waits.finishing.seen(group, now); });
    source.step(in);
    in.step();
  }
  return load.waits.finishing.pitch > 0 ? only_marks(sink.taken()) : sink.taken();
}

TEST_CASE("clocked reference: coarse filter") {
  Comparison table("coarse filter");
  CoarseHardware exact, paper{4, 14, 99, 128, 2, 10};
  exact.port.config = preset_of<ExactConfig>("exact").port;
  paper.port.config = preset_of<PaperConfig>("paper").port;
  exact.numbers = paper.numbers = hardware_of(GroupUse::kFilter);
  const PixelSize of_exact = preset_of<ExactConfig>("exact").group;
  const PixelSize of_paper = preset_of<PaperConfig>("paper").group;
  CoarseHardware tiny = exact;
  tiny.slice_gaussians = 2;
  tiny.input_slots = 1;
  tiny.output_entries = 2;
  CoarseHardware far = exact;
  far.port.read_latency = 300;
  CoarseHardware many = paper;
  many.cfus = 7;
  many.test_cycles = 6;
  many.output_entries = 200;
  for (const CoarseWorkload& load : {
           CoarseWorkload{"light: visits of up to 3", 3, {}, exact},
           CoarseWorkload{"heavy: visits of up to 16", 16, {}, exact},
           CoarseWorkload{"input stalled", 16, {2, 600}, exact},
           CoarseWorkload{"output stalled", 16, {1, 1, 4, 200}, exact},
           CoarseWorkload{"memory of 300 cycles", 16, {}, far},
           CoarseWorkload{"a visit a group", 3, {}, exact, of_exact, 0, 1},
           CoarseWorkload{"tiny buffers", 16, {}, tiny},
           CoarseWorkload{"tiny buffers, output stalled", 16, {1, 1, 4, 200}, tiny},
           CoarseWorkload{"groups that finish", 16, {1, 1, 1, 1, {1500}}, exact, of_exact, 7571},
           CoarseWorkload{"long visits finish", 300, {1, 1, 1, 1, {2500}}, exact, of_exact, 13715},
           CoarseWorkload{"as of paper, visits of up to 256", 256, {}, paper, of_paper},
           CoarseWorkload{"more CFUs than a test has cycles", 256, {}, many, of_paper},
           CoarseWorkload{"as of paper, output stalled", 256, {1, 1, 4, 60}, paper, of_paper},
           CoarseWorkload{"as of paper, groups that finish",
                          256,
                          {1, 1, 1, 1, {7000}},
                          paper,
                          of_paper,
                          14507},
       }) {
    table.workload(load, run_coarse, clocked_coarse, load.apart);
  }
}

// Candidates one behind the other, a mark behind every so many.
struct FineWorkload {
  const char* name;
  std::uint32_t visit = 50;  // candidates
  Waits waits;
  FineHardware hardware;
  PixelSize group = preset_of<ExactConfig>("exact").group;
};

tb::HfuPlan plan_of(const FineWorkload& load, std::uint64_t seed) {
  return fine_plan(shape_of(load.group), load.hardware, load.visit, seed);
}

void run_fine(tb::Case& test, Takings& taken, const FineWorkload& load, std::uint64_t seed) {
  const tb::HfuPlan plan = plan_of(load, seed);
  tb::UnitBench bench(test, bench_of(load.hardware.port, tb::memory_bytes(plan.scene.job)));
  bench.load(0, plan.scene.image.bytes);
  FinishedGroups finished("finished", bench.clock(), plan.scene.job.groups.size(), 1);
  add_finishing(bench, load.waits.finishing, plan.scene.job.groups.size(), finished);
  auto& in = bench.add_fifo<FineCandidate>("candidates", kCandidateEntries, 1);
  auto& out = bench.add_fifo<SplatToken>("splats", load.hardware.output_entries,
                                         plan.config.ffu_depth_cycles);
  const Rejects rejects = load.hardware.reports_rejects ? Rejects::kReported : Rejects::kDropped;
  FineFilter unit("fine", plan.config, plan.codebook, {0, rejects}, bench.context(plan.scene.job));
  unit.candidates(in);
  unit.splats(out);
  unit.finished(finished);
  bench.add_unit(unit);
  add_source(bench, "before", candidates_of(plan), load.waits.in(seed), in);
  add_sink(bench, "behind", until_taken(last_of(plan)), load.waits.out(seed), out, taken,
           what_of_splat);
  bench.run();
}

Takings clocked_fine(const FineWorkload& load, std::uint64_t seed) {
  const tb::HfuPlan plan = plan_of(load, seed);
  FineHardware hardware = load.hardware;
  hardware.read_cycles = (plan.scene.job.layout.second_halves.record_bytes + 31) / 32;
  ClockedFineFilter unit(hardware);
  ClockedFifo<FineItem> in(kCandidateEntries);
  ClockedSource<FineItem> source(clocked_candidates(plan), load.waits.in(seed));
  ClockedSink<std::uint64_t> sink(load.waits.out(seed));
  const auto done = until_taken(last_of(plan));
  for (std::uint64_t now = 0; !done(sink.taken()); ++now) {
    unit.step_results();
    sink.step(unit.out(), now);
    unit.step(in, [&](std::uint32_t group) { return load.waits.finishing.seen(group, now); });
    source.step(in);
    in.step();
  }
  return sink.taken();
}

TEST_CASE("clocked reference: fine filter") {
  Comparison table("fine filter");
  FineHardware exact, paper{6, 27, 176, 7, 7};
  exact.port.config = preset_of<ExactConfig>("exact").port;
  exact.reports_rejects = true;
  exact.numbers = paper.numbers = hardware_of(GroupUse::kPixels);
  paper.port.config = preset_of<PaperConfig>("paper").port;
  const PixelSize of_paper = preset_of<PaperConfig>("paper").group;
  FineHardware tiny = exact;
  tiny.slots = 1;
  tiny.output_entries = 2;
  FineHardware far = exact;
  far.port.read_latency = 300;
  FineHardware two = paper, nine = exact;
  two.ffus = 2;
  two.output_entries = 40;
  nine.ffus = 9;
  nine.test_cycles = 6;
  nine.output_entries = 300;
  nine.slots = 32;
  for (const FineWorkload& load : {
           FineWorkload{"light", 250, {2, 300}, exact},
           FineWorkload{"heavy", 250, {}, exact},
           FineWorkload{"a group of 50", 50, {}, exact},
           FineWorkload{"output stalled", 250, {1, 1, 4, 200}, exact},
           FineWorkload{"memory of 300 cycles", 250, {}, far},
           FineWorkload{"groups that finish", 50, {1, 1, 1, 1, {6000}}, exact},
           FineWorkload{"tiny buffers", 250, {}, tiny},
           FineWorkload{"as of paper, visits of 5", 5, {}, paper, of_paper},
           FineWorkload{"as of paper, visits of 50", 50, {}, paper, of_paper},
           FineWorkload{"as of paper, output stalled", 50, {1, 1, 4, 200}, paper, of_paper},
           FineWorkload{
               "as of paper, groups that finish", 5, {1, 1, 1, 1, {7000}}, paper, of_paper},
           FineWorkload{"two FFUs", 50, {}, two, of_paper},
           FineWorkload{"two FFUs, groups that finish", 5, {1, 1, 1, 1, {3500}}, two, of_paper},
           FineWorkload{"nine FFUs of 6 cycles", 250, {}, nine},
       }) {
    table.workload(load, run_fine, clocked_fine);
  }
}

}  // namespace
}  // namespace sgs::test
