// An HFU with everything around it, and the checks of what it did.
#include "testbench/units/hfu_run.h"

#include <algorithm>
#include <map>

#include "algorithm/memory/splat_record.h"
#include "modules/streaminggs/hfu/filter_datapaths.h"
#include "testbench/units/random_scene.h"

namespace sgs::tb {
namespace {

// One share's splats as they came out: all of them, or of a finished group some, in order.
void check_share(Checks& checks, const HfuPlan& plan, const VisitShare& share,
                 const std::vector<Splat>& expected, const std::vector<Splat>& got, bool all) {
  const SubtileRect group = subtiles_of(plan.scene.job.groups[share.group]);
  const std::string where = fmt::format("visit {}", share.visit);
  if (all) checks.equal(got.size(), expected.size(), where + ": splats");
  auto next = expected.begin();
  for (const Splat& splat : got) {
    next =
        std::find_if(next, expected.end(), [&](const Splat& s) { return s.index == splat.index; });
    if (next == expected.end()) {
      checks.that(false, fmt::format("{}: a splat of slot {} out of order", where, splat.index));
      return;
    }
    const std::string differs = difference(splat, *next++, group);
    checks.that(differs.empty(), fmt::format("{}, slot {}: {}", where, splat.index, differs));
  }
}

// Null where the scene has none. (Its loading is tb_codebook's.)
std::unique_ptr<CodebookBuffer> full_codebooks(UnitBench& bench, const HfuPlan& plan) {
  if (!plan.scene.job.layout.second_half.quantised()) return nullptr;
  CodebookConfig config = plan.codebook;
  config.preloaded = true;
  auto codebooks = std::make_unique<CodebookBuffer>(
      "codebooks", config, bench.context(plan.scene.job), bench.instant_end(), 1);
  bench.add_unit(*codebooks);
  return codebooks;
}

// Reports groups as finished, each in its cycle.
void add_feedback(UnitBench& bench, const HfuPlan& plan, FinishedGroups& finished) {
  bench.add_thread("feedback", [&](Activity&) {
    std::multimap<std::uint64_t, std::uint32_t> groups;
    for (std::uint32_t g = 0; g < plan.finish_cycles.size(); ++g) {
      groups.emplace(plan.finish_cycles[g], g);
    }
    for (const auto& [cycle, group] : groups) {
      bench.clock().wait_cycles(cycle - bench.clock().now_cycles());
      finished.finish(group, 0);
    }
  });
}

// Operations for all shares where no group finishes.
struct Totals {
  std::uint64_t gaussians = 0, passed = 0, lines = 0, splats = 0;
};

Totals totals_of(const std::vector<ExpectedShare>& shares) {
  Totals sum;
  for (const ExpectedShare& share : shares) {
    sum.gaussians += share.passes.size();
    sum.splats += share.splats.size();
    for (std::size_t i = 0; i < share.passes.size(); ++i) {
      sum.passed += share.passes[i] ? 1 : 0;
      sum.lines += share.passes[i] && !share.lines.empty() ? share.lines[i] : 0;
    }
  }
  return sum;
}

// Checks an activity that is busy for `least` cycles and may wait for turns.
void check_busy(UnitBench& bench, const char* what, std::uint64_t least, std::uint64_t turns,
                std::uint64_t beside) {
  const std::uint64_t cycles = bench.busy_cycles(what);
  bench.checks().that(cycles + beside >= least, fmt::format("busy cycles, {}: too few", what));
  bench.checks().that(cycles <= least + turns + beside,
                      fmt::format("busy cycles, {}: too many", what));
}

void check_counters(UnitBench& bench, const HfuPlan& plan, const Totals& all, bool any_finished) {
  Checks& checks = bench.checks();
  const RecordArray& second_halves = plan.scene.job.layout.second_halves;
  const bool quantised = plan.scene.job.layout.second_half.quantised();
  // Where they do not filter they find depths all the same.
  const std::uint64_t coarse = has_cfus(plan.config, plan.scene.job.layout.split.bound_by)
                                   ? bench.accesses("input").first
                                   : 0;
  if (plan.config.coarse_filter) bench.check_counter("coarse_tests", coarse);
  if (coarse > 0) bench.check_operations("coarse", "fp32_lane", coarse * plan.config.cfu_macs);
  bench.check_operations("fine", "fp32_lane", bench.counter("fine_tests") * plan.config.ffu_macs);
  // Every half that was fetched went into its buffer, in words of 32 B the second ones.
  const std::uint64_t halves = bench.counter("first_halves");
  checks.equal(bench.accesses("input").second, halves, "first halves written");
  checks.that(bench.accesses("input").first <= halves, "first halves read");
  const std::uint64_t read_cycles = (second_halves.record_bytes + 31) / 32;
  const std::uint64_t words = bench.counter("second_halves") * read_cycles;
  bench.check_accesses("second halves", words, words);
  const std::uint64_t tests = bench.counter("fine_tests");
  checks.equal(bench.accesses("input").first - bench.counter("coarse_candidates") + tests +
                   bench.counter("dropped_saturated"),
               all.gaussians, "Gaussians rejected, tested or dropped");
  if (any_finished) {
    checks.that(!quantised || (bench.counter("records_decoded") <= bench.counter("second_halves") &&
                               bench.counter("records_decoded") >= tests),
                "records decoded");
    return;
  }
  bench.check_counter("first_halves", all.gaussians);
  bench.check_counter("coarse_tests", plan.config.coarse_filter ? all.gaussians : 0);
  bench.check_counter("coarse_passed", all.passed);
  bench.check_counter("second_halves", all.passed);
  bench.check_counter("fine_tests", all.passed);
  bench.check_counter("splats", all.splats);
  const std::uint64_t shares = plan.shares.size(), interval = plan.config.ffu_interval_cycles();
  check_busy(bench, "coarse", all.gaussians + shares,
             coarse * (plan.config.cfu_interval_cycles() + plan.config.cfus), 0);
  // Marks may pass beside the lanes; a stall of the FIFO behind counts in place of their work.
  // Several FFUs are busy at a time.
  const std::uint64_t of_read = quantised ? 1 : read_cycles, all_busy = std::max(interval, of_read);
  const std::uint64_t of_test = plan.config.ffus > 1 ? of_read : all_busy;
  const std::uint64_t turns = interval - 1 + (all_busy - of_test);
  check_busy(bench, "fine", tests * of_test + shares, tests * turns,
             shares + (bench.without_stalls() ? 0 : tests * interval));
  if (!quantised) return;
  bench.check_counter("records_decoded", all.passed);
  bench.check_counter("lines_read", all.lines);
  bench.check_counter("bank_conflict_cycles", 0);  // there is only one reader
  checks.equal(bench.busy_cycles("decode"), all.lines + shares, "busy cycles, decode");
}

}  // namespace

std::unique_ptr<Hfu> bound_hfu(UnitBench& bench, const HfuPlan& plan, FinishedGroups& finished,
                               TimedFifo<VisitShare>& shares, const Fifos<SplatToken>& splats,
                               CodebookBuffer* codebooks) {
  auto unit =
      std::make_unique<Hfu>("hfu", plan.config, plan.codebook,
                            FineFilterPlace{0, Rejects::kDropped}, bench.context(plan.scene.job));
  auto& candidates = bench.add_fifo<FineCandidate>("candidates", plan.config.candidate_fifo_entries,
                                                   plan.config.cfu_depth_cycles);
  unit->coarse.shares(shares);
  unit->coarse.survivors(candidates);
  unit->coarse.finished(finished);
  unit->fine.candidates(candidates);
  for (TimedFifo<SplatToken>* fifo : splats) unit->fine.splats(*fifo);
  unit->fine.finished(finished);
  if (codebooks != nullptr) unit->fine.codebooks(*codebooks);
  bench.add_unit(*unit);
  return unit;
}

void run_hfu(Case& test, const BenchConfig& bench_config, const HfuPlan& plan) {
  UnitBench bench(test, bench_config);
  Checks& checks = bench.checks();
  bench.load(0, plan.scene.image.bytes);
  FinishedGroups finished("finished", bench.clock(), plan.scene.job.groups.size(),
                          plan.feedback_cycles);
  auto& input = bench.add_fifo<VisitShare>("shares", kVisitFifoEntries, 1);
  const auto outputs =
      bench.add_fifos<SplatToken>("to_sorting", plan.sorting_units, plan.output_entries, 1);
  const std::unique_ptr<CodebookBuffer> codebooks = full_codebooks(bench, plan);
  const std::unique_ptr<Hfu> unit =
      bound_hfu(bench, plan, finished, input, outputs, codebooks.get());

  // The expected outcome if nobody tells the HFU that a group is finished.
  std::vector<ExpectedShare> expected;
  for (const VisitShare& share : plan.shares) expected.push_back(expect(plan, share));

  bench.add_thread("vsu", [&](Activity& activity) {
    for (const VisitShare& share : plan.shares) input.push(share, activity);
  });
  add_feedback(bench, plan, finished);
  for (std::uint32_t s = 0; s < plan.sorting_units; ++s) {
    bench.add_thread(fmt::format("sorting{}", s), [&, s](Activity& activity) {
      for (std::size_t k = 0; k < plan.shares.size(); ++k) {
        const VisitShare& share = plan.shares[k];
        if (share.visit % plan.sorting_units != s) continue;
        std::vector<Splat> got;
        SplatToken token = outputs[s]->pop(activity);
        for (; token.mark == Mark::kNone; token = outputs[s]->pop(activity)) {
          checks.equal(token.visit, share.visit, "visit of a splat");
          checks.equal(token.group, share.group, "group of a splat");
          got.push_back(token.splat);
          if (plan.saturate_one_in > 0 &&
              test.random() % static_cast<unsigned>(plan.saturate_one_in) == 0) {
            finished.finish(share.group, 0);
          }
        }
        checks.that(
            token.mark == share.mark && token.visit == share.visit && token.group == share.group,
            fmt::format("visit {}: its end", share.visit));
        check_share(checks, plan, share, expected[k].splats, got, !finished.finished(share.group));
      }
    });
  }
  bench.run();

  bench.check_counter("shares", plan.shares.size());
  const RecordSplit& split = plan.scene.job.layout.split;
  checks.equal(unit->coarse.memory.bytes_read(),
               bench.counter("first_halves") * split.first_bytes(), "bytes read of first halves");
  checks.equal(unit->fine.memory.bytes_read(), bench.counter("second_halves") * split.second_bytes,
               "bytes read of second halves");
  bool any_finished = false;
  for (std::uint32_t g = 0; g < plan.scene.job.groups.size(); ++g) {
    any_finished = any_finished || finished.finished(g);
  }
  check_counters(bench, plan, totals_of(expected), any_finished);
}

}  // namespace sgs::tb
