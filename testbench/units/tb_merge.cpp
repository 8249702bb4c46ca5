// Merge unit alone: sorted keys of the visits of several groups in, keys in final order out.
// Checked against std::sort by (depth, slot); cycles, bytes and conservation.
#include <algorithm>
#include <limits>

#include "modules/streaminggs/merge/merge_unit.h"
#include "testbench/units/case_runner.h"
#include "testbench/units/job_memory.h"
#include "testbench/units/merge_plan.h"
#include "testbench/units/reported_groups.h"
#include "testbench/units/unit_bench.h"

namespace sgs::tb {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::uint64_t kBytesOfKey = 32;  // depth, slot, centre, two carried words, reach

bool same_payload(const FineCandidate& a, const FineCandidate& b) {
  return a.slot == b.slot && a.depth == b.depth && a.mean_x == b.mean_x && a.mean_y == b.mean_y &&
         a.mean_z == b.mean_z && a.carried == b.carried;
}

// For visits as long as the plan's.
UnitContext merge_context(const UnitBench& bench, const StreamingJob& job, const MergePlan& plan) {
  UnitContext context = bench.context(job);
  context.built_for.chunk_gaussians = longest_visit(plan);
  context.built_for.group_px = 16;
  return context;
}

struct Run {
  UnitBench bench;
  StreamingJob job;
  ReportedGroups finished;
  FinishedSubtiles mask;
  Fifos<FineCandidate> inputs, outputs;
  MergeUnit unit;

  Run(Case& test, const BenchConfig& config, const MergePlan& plan)
      : bench(test, config),
        job(merge_job(plan)),
        finished(bench.clock(), plan.groups.size(), plan.feedback_cycles),
        mask("mask", bench.clock(), job.groups, plan.feedback_cycles),
        inputs(bench.add_fifos<FineCandidate>("sorted_by", plan.sorters, plan.input_entries, 1)),
        outputs(bench.add_fifos<FineCandidate>("to_hfu", plan.hfus, plan.output_entries, 1)),
        unit("merge", plan.config, job.spill, merge_context(bench, job, plan)) {
    for (TimedFifo<FineCandidate>* input : inputs) unit.sorted(*input);
    for (TimedFifo<FineCandidate>* output : outputs) unit.released(*output);
    unit.finished(finished.channel);
    unit.mask(mask);
    bench.add_unit(unit);
  }
};

// One thread a sorting unit: its visits, each with its mark; a group's end is a visit of its own.
void add_sorters(Run& run, const MergePlan& plan) {
  for (std::uint32_t s = 0; s < plan.sorters; ++s) {
    run.bench.add_thread(fmt::format("sorter{}", s), [&, s](Activity& activity) {
      std::uint32_t number = 0;
      for (std::uint32_t g = 0; g < plan.groups.size(); ++g) {
        const std::vector<MergeVisit>& visits = plan.groups[g].visits;
        for (std::size_t v = 0; v <= visits.size(); ++v, ++number) {
          if (number % plan.sorters != s) continue;
          FineCandidate end;
          end.group = g;
          end.visit = number;
          end.mark = v < visits.size() ? Mark::kEndOfVisit : Mark::kEndOfGroup;
          end.release_below = v < visits.size() ? visits[v].release_below : kInfinity;
          if (v < visits.size()) {
            for (const MergeKey& key : visits[v].keys) {
              run.inputs[s]->push(candidate(g, number, key), activity);
            }
          }
          run.inputs[s]->push(end, activity);
        }
      }
    });
  }
}

// Takes the keys in turn, as rendering takes their splats.
void add_reader(Run& run, const MergePlan& plan) {
  run.bench.add_thread("reader", [&](Activity& activity) {
    Checks& checks = run.bench.checks();
    std::size_t turn = 0;
    const auto next = [&] { return run.outputs[turn++ % plan.hfus]->pop(activity); };
    for (std::uint32_t g = 0; g < plan.groups.size(); ++g) {
      const MergeGroup& group = plan.groups[g];
      const std::vector<MergeKey> expected = expected_order(plan, group);
      std::size_t got = 0;
      FineCandidate key = next();
      for (; key.mark == Mark::kNone; key = next(), ++got) {
        const bool there = got < expected.size();
        checks.that(there, fmt::format("group {}: too many keys", g));
        if (there) {
          checks.that(
              key.group == g && same_payload(key, candidate(g, 0, expected[got])),
              fmt::format("group {}, key {}: slot {} at depth {}, expected {} at {}", g, got,
                          key.slot, key.depth, expected[got].slot, expected[got].depth));
        }
        // Decided on before the heap was at work, then it went through the FIFO.
        if (run.bench.without_stalls()) {
          const std::uint64_t cycles = plan.config.cycles_per_operation + 1;
          checks.that(run.bench.clock().now_cycles() - cycles < run.finished.seen_from(g),
                      fmt::format("group {}: key {} although the group is finished", g, got));
        }
        if (got + 1 >= group.saturates_after) run.finished.finish(g);
      }
      checks.that(key.mark == Mark::kEndOfGroup && key.group == g, fmt::format("group {}: end", g));
      if (!run.finished.finished(g)) {
        checks.equal(got, expected.size(), fmt::format("group {}: keys", g));
      }
    }
  });
}

// Keys released behind one of the same depth.
std::uint64_t tied_keys(const MergePlan& plan, const MergeGroup& group) {
  const std::vector<MergeKey> keys = expected_order(plan, group);
  std::uint64_t tied = 0;
  for (std::size_t k = 1; k < keys.size(); ++k) tied += keys[k].depth == keys[k - 1].depth ? 1 : 0;
  return tied;
}

void check_counters(Run& run, const MergePlan& plan) {
  Checks& checks = run.bench.checks();
  const MergeUnit::Counters& c = run.unit.counters();
  std::uint64_t keys = 0;
  bool saturating = false;
  for (std::uint32_t g = 0; g < plan.groups.size(); ++g) {
    saturating = saturating || run.finished.finished(g);
    for (const MergeVisit& visit : plan.groups[g].visits) keys += visit.keys.size();
  }
  run.bench.check_counter("keys", keys);
  std::uint64_t tied = 0;
  for (const MergeGroup& group : plan.groups) tied += tied_keys(plan, group);
  if (!saturating) run.bench.check_counter("ties", tied);
  checks.that(c.ties <= tied, "more ties than keys of one depth");
  checks.equal(c.released + c.dropped_hidden + c.dropped_saturated, keys, "keys accounted for");
  if (!saturating) run.bench.check_counter("released", keys);
  // What the heap takes and gives at its own pace; a cycle for a key that is dropped on arrival,
  // read from a run or moved to another, and for a mark.
  const HeapWork& heap = run.unit.heap_work();
  run.bench.check_counter("inserts", heap.inserts);
  run.bench.check_counter("delete_mins", heap.delete_mins);
  run.bench.check_counter("delete_maxs", heap.delete_maxs);
  checks.equal(run.bench.busy_cycles("merge"),
               plan.config.cycles_per_operation * heap.operations() + (c.keys - heap.inserts) +
                   (c.due - heap.delete_mins) + (c.keys_spilled - heap.delete_maxs) +
                   plan.groups.size(),
               "busy cycles");
  if (!saturating) {
    checks.equal(heap.inserts, keys, "inserts");
    checks.equal(heap.delete_mins + heap.delete_maxs, keys, "deletes");
  }
  checks.equal(run.bench.bytes_written(), run.bench.counter("keys_spilled") * kBytesOfKey,
               "bytes written");
  if (!saturating) {
    checks.equal(run.bench.bytes_read(), c.keys_spilled * kBytesOfKey, "bytes read back");
  }
  if (plan.config.on_overflow == OnOverflow::kSpill) {
    checks.that(run.bench.counter("pending_keys_max") <= plan.config.entries,
                "more keys wait than fit");
    run.bench.check_counter("forced_early", 0);
  } else {
    run.bench.check_counter("runs_spilled", 0);
  }
  // Two nodes a word read, one written; a key is depth and slot.
  const std::uint64_t words = run.bench.counter("heap_words_read");
  run.bench.check_accesses("waiting keys", 2 * words, run.bench.counter("heap_nodes_written"));
  std::uint64_t comparisons = 2 * run.bench.counter("heap_comparisons");
  comparisons += 4 * c.due;  // 4 rows of 4 sub-tiles, of 16 px
  run.bench.check_accesses("finished sub-tiles", c.due, run.mask.news());
  if (plan.config.on_overflow == OnOverflow::kSpill) {
    comparisons += 2 * (plan.config.spill_runs - 1) * run.bench.counter("keys_spilled");
  }
  run.bench.check_operations("merge", "comparator", comparisons);
  // Nothing went past the spill area.
  const RegionSpan& spill = run.job.spill;
  const std::vector<std::byte> behind =
      run.bench.read_back(spill.end(), run.job.frame_buffer.end() - spill.end());
  checks.that(
      std::all_of(behind.begin(), behind.end(), [](std::byte b) { return b == std::byte{}; }),
      "written past the spill area");
}

MergeUnit::Counters run_plan(Case& test, const BenchConfig& config, const MergePlan& plan) {
  Run run(test, config, plan);
  add_sorters(run, plan);
  add_reader(run, plan);
  run.bench.run();
  check_counters(run, plan);
  return run.unit.counters();
}

BenchConfig still_bench(const MergePlan& plan) {
  BenchConfig config;
  config.memory_bytes = memory_bytes(merge_job(plan));
  return config;
}

void random_case(Case& test) {
  std::mt19937_64& random = test.random;
  MergePlan plan;
  plan.slots = static_cast<std::uint32_t>(random() % 400);
  plan.sorters = 1 + static_cast<std::uint32_t>(random() % 4);
  plan.hfus = 1 + static_cast<std::uint32_t>(random() % 5);
  plan.input_entries = 1 + static_cast<std::uint32_t>(random() % 16);
  plan.output_entries = 1 + static_cast<std::uint32_t>(random() % 6);
  plan.config.entries = 2 + static_cast<std::uint32_t>(random() % (random() % 2 == 0 ? 20 : 400));
  plan.config.cycles_per_operation = 1 + static_cast<std::uint32_t>(random() % 4);
  plan.config.spill_runs = 2 + static_cast<std::uint32_t>(random() % 6);
  plan.config.spill_block_entries = 1 + static_cast<std::uint32_t>(random() % 10);
  if (random() % 5 == 0) plan.config.on_overflow = OnOverflow::kBlendEarly;
  constexpr std::uint32_t kDepths[] = {1, 5, 50, 100000};
  for (std::size_t g = 0; g < 1 + random() % 4; ++g) {
    plan.groups.push_back(random_group(random, plan, 1 + static_cast<std::uint32_t>(random() % 40),
                                       kDepths[random() % 4]));
    if (random() % 4 == 0) plan.groups.back().saturates_after = 1 + random() % 100;
  }
  plan.feedback_cycles = 1 + static_cast<std::uint32_t>(random() % 40);
  run_plan(test, random_bench(random, still_bench(plan).memory_bytes), plan);
}

// n keys without ties that wait at the input: an operation each in, one each out.
void exact_time(Case& test, std::uint32_t n, std::uint32_t cycles_per_operation) {
  MergePlan plan;
  plan.slots = n;
  plan.config.cycles_per_operation = cycles_per_operation;
  plan.sorters = plan.hfus = 1;
  plan.input_entries = n + 2;
  plan.output_entries = n + 1;
  plan.groups.push_back(one_visit(n, false));
  plan.groups[0].visits[0].release_below = kInfinity;
  Run run(test, still_bench(plan), plan);
  add_sorters(run, plan);
  run.bench.add_thread("reader", [&](Activity& activity) {
    // FIFO in, n in, the first out (the mark, where there is none), FIFO out.
    std::uint64_t due = 1 + n * cycles_per_operation + (n > 0 ? cycles_per_operation : 1) + 1;
    run.bench.wait_until_just_before(due);
    run.bench.checks().that(!run.outputs[0]->can_pop(), "released a cycle too soon");
    for (std::uint32_t i = 0; i <= n; ++i) {
      run.outputs[0]->pop(activity);
      run.bench.checks().equal(run.bench.clock().now_cycles(), due, "time of a key");
      due += i + 1 < n ? cycles_per_operation : 1;
    }
  });
  run.bench.run();
}

// What is final comes out although nothing more goes in; what ties with the bound does not.
void final_keys_do_not_wait(Case& test) {
  MergePlan plan;
  plan.slots = 4;
  plan.sorters = plan.hfus = 1;
  plan.groups.emplace_back();
  Run run(test, still_bench(plan), plan);
  std::uint64_t last_in = 0;
  run.bench.add_thread("sorter", [&](Activity& activity) {
    const MergeKey keys[] = {{1, 0}, {2, 3}, {3, 2}};
    for (const MergeKey& key : keys) run.inputs[0]->push(candidate(0, 0, key), activity);
    FineCandidate end;
    end.mark = Mark::kEndOfVisit;
    end.release_below = 2;
    run.inputs[0]->push(end, activity);
    run.bench.clock().wait_cycles(1000);
    last_in = run.bench.clock().now_cycles();
    run.inputs[0]->push(candidate(0, 1, {2, 1}), activity);
    end.visit = 1;
    end.release_below = kInfinity;
    run.inputs[0]->push(end, activity);
    end.visit = 2;
    end.mark = Mark::kEndOfGroup;
    run.inputs[0]->push(end, activity);
  });
  run.bench.add_thread("reader", [&](Activity& activity) {
    Checks& checks = run.bench.checks();
    checks.equal(run.outputs[0]->pop(activity).slot, 0U, "the first key");
    checks.that(run.bench.clock().now_cycles() < 20, "a final key waited");
    checks.equal(run.outputs[0]->pop(activity).slot, 1U, "the lower slot");
    checks.that(run.bench.clock().now_cycles() > last_in && last_in > 0,
                "a key was released before its tie had come");
    checks.equal(run.outputs[0]->pop(activity).slot, 3U, "the higher slot");
    checks.equal(run.outputs[0]->pop(activity).slot, 2U, "the last key");
    checks.that(run.outputs[0]->pop(activity).mark == Mark::kEndOfGroup, "the end");
  });
  run.bench.run();
}

// Sub-tiles (0, 0) to (1, 2) of 4 x 4 are finished in cycle 5000, and seen 7 later: what reaches
// them alone is dropped from then on, whatever else is released.
void keys_behind_finished_subtiles(Case& test) {
  MergePlan plan;
  plan.slots = 8;
  plan.sorters = plan.hfus = 1;
  plan.feedback_cycles = 7;
  plan.groups.resize(2);
  plan.config.entries = 4;  // some come back from a run
  Run run(test, still_bench(plan), plan);
  run.bench.add_thread("rendering", [&](Activity&) {
    run.bench.clock().wait_cycles(5000);
    for (const std::size_t at : {0U, 1U, 4U, 5U, 8U, 9U}) run.mask.finish(0, at, 0);
  });
  const auto group = [&](Activity& activity, std::uint32_t g, std::uint32_t visit) {
    // Inside; inside to the edges; one column, one row too many; all.
    const GroupReach reaches[] = {{1, 1, 1, 1}, {0, 0, 1, 2}, {0, 0, 2, 2}, {0, 0, 1, 3}, {}};
    float depth = 1;
    for (const GroupReach& reach : reaches) {
      FineCandidate key = candidate(g, visit, {depth, static_cast<std::uint32_t>(depth)});
      key.reach = reach;
      depth += 1;
      run.inputs[0]->push(key, activity);
    }
    FineCandidate end;
    end.group = g;
    end.visit = visit;
    end.mark = Mark::kEndOfVisit;
    end.release_below = kInfinity;
    run.inputs[0]->push(end, activity);
  };
  run.bench.add_thread("sorter", [&](Activity& activity) {
    group(activity, 0, 0);
    run.bench.clock().wait_cycles(10000);
    group(activity, 0, 1);
    FineCandidate end;
    end.visit = 2;
    end.mark = Mark::kEndOfGroup;
    run.inputs[0]->push(end, activity);
    group(activity, 1, 3);
    end.group = 1;
    end.visit = 4;
    run.inputs[0]->push(end, activity);
  });
  run.bench.add_thread("reader", [&](Activity& activity) {
    // Before the news all; behind it three; nothing is known of the next group.
    for (const std::uint32_t slot : {1U, 2U, 3U, 4U, 5U, 3U, 4U, 5U, 0U, 1U, 2U, 3U, 4U, 5U, 0U}) {
      const FineCandidate key = run.outputs[0]->pop(activity);
      run.bench.checks().equal(key.mark == Mark::kNone ? key.slot : 0U, slot, "the next key");
    }
  });
  run.bench.run();
  run.bench.check_counter("dropped_hidden", 2);
  run.bench.check_counter("due", 15);
}

void one_group(Case& test, std::uint32_t n, std::uint32_t entries, bool tied,
               const std::function<void(Checks&, const MergeUnit::Counters&)>& also) {
  MergePlan plan;
  plan.slots = n;
  plan.config.entries = entries;
  plan.config.spill_runs = 3;
  plan.groups.push_back(one_visit(n, tied));
  also(test.checks, run_plan(test, still_bench(plan), plan));
}

}  // namespace
}  // namespace sgs::tb

int sc_main(int argc, char* argv[]) {
  using namespace sgs;
  using namespace sgs::tb;
  CaseRunner runner("tb_merge", "Merge unit alone, against std::sort by depth and slot");
  runner.add_directed("groups without a visit, visits without a key", [](Case& test) {
    MergePlan plan;
    plan.slots = 8;
    plan.groups.resize(5);
    plan.groups[1].visits.resize(3);
    plan.groups[3].visits.resize(1);
    run_plan(test, still_bench(plan), plan);
  });
  runner.add_directed("final keys do not wait, tied ones do", final_keys_do_not_wait);
  runner.add_directed("keys behind finished sub-tiles are dropped", keys_behind_finished_subtiles);
  const auto spills = [](Checks& checks, const MergeUnit::Counters& c) {
    checks.that(c.runs_spilled > 0, "nothing was spilled");
  };
  const auto merges_runs = [](Checks& checks, const MergeUnit::Counters& c) {
    checks.that(c.runs_spilled > 3, "runs were not merged");
    checks.that(c.keys_spilled > c.keys / 2, "too few keys were spilled");
  };
  runner.add_directed("keys that all fit", [](Case& test) {
    one_group(test, 100, 100, false, [](Checks& checks, const MergeUnit::Counters& c) {
      checks.equal(c.runs_spilled, std::uint64_t{0}, "runs spilled");
      checks.equal(c.ties, std::uint64_t{0}, "ties");
    });
  });
  runner.add_directed("one key more than fits",
                      [=](Case& test) { one_group(test, 101, 100, false, spills); });
  runner.add_directed("many runs, merged in DRAM",
                      [=](Case& test) { one_group(test, 700, 20, false, merges_runs); });
  runner.add_directed("capacity of two keys",
                      [=](Case& test) { one_group(test, 60, 2, false, merges_runs); });
  runner.add_directed("all keys at one depth",
                      [](Case& test) { one_group(test, 300, 300, true, [](auto&, auto&) {}); });
  runner.add_directed("all keys at one depth, spilled",
                      [=](Case& test) { one_group(test, 300, 20, true, spills); });
  runner.add_directed("all keys at one depth, capacity of two keys",
                      [=](Case& test) { one_group(test, 40, 2, true, spills); });
  runner.add_directed("groups finished while keys wait on chip and in DRAM", [](Case& test) {
    MergePlan plan;
    plan.slots = 300;
    plan.config.entries = 24;
    for (const std::uint64_t after : {1U, 10U, 60U, 299U}) {
      plan.groups.push_back(random_group(test.random, plan, 16, 20));
      plan.groups.back().saturates_after = after;
      plan.groups.push_back(random_group(test.random, plan, 16, 20));
    }
    run_plan(test, still_bench(plan), plan);
  });
  runner.add_directed("blend_early", [](Case& test) {
    MergePlan plan;
    plan.slots = 300;
    plan.config.entries = 8;
    plan.config.on_overflow = OnOverflow::kBlendEarly;
    for (int g = 0; g < 3; ++g) plan.groups.push_back(random_group(test.random, plan, 16, 30));
    const MergeUnit::Counters c = run_plan(test, still_bench(plan), plan);
    test.checks.that(c.forced_early > 0, "nothing was forced out");
  });
  runner.add_directed("bytes of a spill: keys out and back", [](Case& test) {
    MergePlan plan;
    plan.slots = 70;
    plan.config.entries = 64;
    plan.groups.push_back(one_visit(70, false));
    Run run(test, still_bench(plan), plan);
    add_sorters(run, plan);
    add_reader(run, plan);
    run.bench.run();
    // 64 wait: an eighth goes, 8 keys, and the other 6 fit.
    test.checks.equal(run.unit.counters().keys_spilled, std::uint64_t{8}, "keys spilled");
    test.checks.equal(run.bench.bytes_written(), std::uint64_t{8 * kBytesOfKey}, "bytes written");
    test.checks.equal(run.bench.bytes_read(), std::uint64_t{8 * kBytesOfKey}, "bytes read");
  });
  for (const std::uint32_t n : {0U, 1U, 2U, 16U, 100U}) {
    for (const std::uint32_t cycles : {1U, 2U, 3U}) {
      runner.add_directed(fmt::format("time of {} keys, an operation every {} cycles", n, cycles),
                          [=](Case& test) { exact_time(test, n, cycles); });
    }
  }
  runner.set_random(random_case);
  return runner.run(argc, argv);
}
