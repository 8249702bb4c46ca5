// The sorting unit of paper order against its clocked reference.
#include <catch2/catch.hpp>

#include "modules/streaminggs/sorting/paper_sorter.h"
#include "testbench/units/job_memory.h"
#include "testbench/units/random_scene.h"
#include "tests/modules/clocked/comparison.h"
#include "tests/modules/streaminggs/clocked/clocked_paper_sorter.h"

namespace sgs::test {
namespace {

constexpr std::uint64_t kSplatMark = 1U << 30U;
constexpr std::uint32_t kGroups = 10, kVisitsOfGroup = 6;

struct PaperSorterWorkload {
  const char* name;
  std::uint32_t fewest, most;  // splats of a visit
  std::uint32_t in_one_in = 1, in_longest = 1, out_one_in = 1, out_longest = 1;
  std::uint32_t in_entries = 7, out_entries = 4, hfus = 4;
  NetworkTurns turns = {};
  bool skip_trivial = true;
  Finishing finishing = {};
  NumberFormat splats = NumberFormat::kSingle;
};

SplatToken mark_of(std::uint32_t visit) {
  SplatToken mark;
  mark.visit = visit;
  mark.group = visit / kVisitsOfGroup;
  mark.mark = (visit + 1) % kVisitsOfGroup == 0 ? Mark::kEndOfGroup : Mark::kEndOfVisit;
  return mark;
}

// [HFU] what it hands on.
std::vector<std::vector<SplatToken>> inputs_of(const PaperSorterWorkload& load,
                                               std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<std::vector<SplatToken>> inputs(load.hfus);
  for (std::uint32_t visit = 0; visit < kGroups * kVisitsOfGroup; ++visit) {
    SplatToken token = mark_of(visit);
    token.mark = Mark::kNone;
    for (std::uint64_t left = load.fewest + random() % (load.most - load.fewest + 1); left > 0;
         --left) {
      token.splat.index = static_cast<std::uint32_t>(left);  // descends: equal depths are put right
      token.splat.depth = static_cast<float>(random() % 1000);
      inputs[random() % load.hfus].push_back(token);
    }
    for (std::vector<SplatToken>& input : inputs) input.push_back(mark_of(visit));
  }
  return inputs;
}

std::uint64_t what_of(const SplatToken& token) {
  if (token.mark != Mark::kNone) return kSplatMark;
  return static_cast<std::uint64_t>(token.splat.depth) << 10U | token.splat.index;
}

// Takes until it has the marks of all visits.
void run_paper_sorter(tb::Case& test, Takings& taken, const PaperSorterWorkload& load,
                      std::uint64_t seed) {
  constexpr int kSide = 32;
  const StreamingJob job = tb::frame_job(kSide * static_cast<int>(kGroups), kSide, square_of(kSide),
                                         FrameFormat::kRgb8, kSplatEntryBytes);
  tb::BenchConfig bench_config;
  bench_config.memory_bytes = tb::memory_bytes(job);
  tb::UnitBench bench(test, bench_config);
  PaperSorterConfig config;
  config.sort_interval_cycles = load.turns.block_cycles;
  config.merge_interval_cycles = load.turns.merge_cycles;
  config.skip_trivial = load.skip_trivial;
  UnitContext context = bench.context(job);
  context.built_for.splats = load.splats;
  PaperSorter unit("sorter", config, {0, 1, job.spill, load.turns.lists}, context);
  const auto in = bench.add_fifos<SplatToken>("in", load.hfus, load.in_entries, 1);
  auto& out = bench.add_fifo<SplatToken>("out", load.out_entries, 1);
  FinishedGroups finished("finished", bench.clock(), kGroups, 1);
  for (TimedFifo<SplatToken>* fifo : in) unit.splats(*fifo);
  unit.sorted(out);
  unit.finished(finished);
  bench.add_unit(unit);
  const std::vector<std::vector<SplatToken>> inputs = inputs_of(load, seed);
  for (std::uint32_t h = 0; h < load.hfus; ++h) {
    add_source(bench, fmt::format("hfu{}", h), inputs[h],
               {seed + h, load.in_one_in, load.in_longest}, *in[h]);
  }
  bench.add_thread("behind", [&](Activity& activity) {
    const Pace pace(seed + 1000, load.out_one_in, load.out_longest);
    for (std::uint32_t marks = 0; marks < kGroups * kVisitsOfGroup;) {
      bench.clock().wait_cycles(pace.gap(taken.size()));
      taken.push_back({0, what_of(out.pop(activity))});
      taken.back().cycle = bench.clock().now_cycles();
      marks += taken.back().what == kSplatMark ? 1 : 0;
    }
  });
  add_finishing(bench, load.finishing, kGroups, finished);
  bench.run();
}

Takings clocked_paper_sorter(const PaperSorterWorkload& load, std::uint64_t seed) {
  ClockedPaperSorter unit(load.turns, load.skip_trivial, load.hfus);
  std::vector<ClockedFifo<PaperSorterItem>> in(load.hfus,
                                               ClockedFifo<PaperSorterItem>(load.in_entries));
  ClockedFifo<PaperSorterItem> out(load.out_entries);
  std::vector<ClockedSource<PaperSorterItem>> sources;
  for (const std::vector<SplatToken>& input : inputs_of(load, seed)) {
    std::vector<PaperSorterItem> items;
    for (const SplatToken& token : input) {
      items.push_back({what_of(token), token.group, token.mark != Mark::kNone});
    }
    sources.emplace_back(std::move(items),
                         Pace(seed + sources.size(), load.in_one_in, load.in_longest));
  }
  ClockedSink<PaperSorterItem> sink({seed + 1000, load.out_one_in, load.out_longest});
  std::uint32_t marks = 0;
  for (std::uint64_t now = 0; marks < kGroups * kVisitsOfGroup; ++now) {
    sink.step(out, now, [&](const PaperSorterItem& item) {
      marks += item.is_mark ? 1 : 0;
      return item.key;
    });
    unit.step(in, out, [&](std::uint32_t group) { return load.finishing.seen(group, now); });
    for (std::size_t h = 0; h < in.size(); ++h) sources[h].step(in[h]);
    for (ClockedFifo<PaperSorterItem>& fifo : in) fifo.step();
    out.step();
  }
  return sink.taken();
}

TEST_CASE("clocked reference: sorting unit of paper order, nothing spilled") {
  Comparison table("paper sorter");
  const NetworkTurns alone, folded{3, 4, 1}, fast{1, 1, 1}, slow{1, 3, 1}, of_two{1, 2, 2},
      of_four{2, 1, 4};
  for (const PaperSorterWorkload& load : {
           PaperSorterWorkload{"light: visits of up to 2", 0, 2},
           PaperSorterWorkload{"visits of 2 to 16", 2, 16},
           PaperSorterWorkload{"visits of 17 to 64", 17, 64},
           PaperSorterWorkload{"heavy: visits of 65 to 256", 65, 256},
           PaperSorterWorkload{"a full buffer", 256, 256},
           PaperSorterWorkload{"input stalled", 0, 64, 4, 60},
           PaperSorterWorkload{"output stalled", 0, 64, 1, 1, 4, 60},
           PaperSorterWorkload{"tiny buffers", 0, 64, 4, 20, 4, 20, 1, 1},
           PaperSorterWorkload{"one HFU", 0, 64, 1, 1, 1, 1, 7, 4, 1},
           PaperSorterWorkload{"up to 2, none skipped", 0, 2, 1, 1, 1, 1, 7, 4, 4, alone, false},
           PaperSorterWorkload{"a block in 3, a merge in 4", 0, 256, 1, 1, 1, 1, 7, 4, 4, folded},
           PaperSorterWorkload{"a merge every cycle", 0, 256, 1, 1, 1, 1, 7, 4, 4, fast},
           PaperSorterWorkload{"a merge every 3 cycles", 0, 256, 1, 1, 1, 1, 7, 4, 4, slow},
           PaperSorterWorkload{"network of 2 lists", 0, 256, 1, 1, 1, 1, 7, 4, 4, of_two},
           PaperSorterWorkload{"network of 4 lists", 0, 256, 1, 1, 1, 1, 7, 4, 4, of_four},
           PaperSorterWorkload{
               "groups that finish", 0, 64, 1, 1, 1, 1, 7, 4, 4, alone, true, {600}},
           PaperSorterWorkload{
               "in halves", 0, 256, 1, 1, 1, 1, 7, 4, 4, alone, true, {}, NumberFormat::kHalf},
       }) {
    table.workload(load, run_paper_sorter, clocked_paper_sorter);
  }
}

}  // namespace
}  // namespace sgs::test
