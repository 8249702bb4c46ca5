// Merge unit alone: sorted keys of the visits of several groups in, keys in final order out.
#include <fmt/format.h>

#include <algorithm>

#include "testbench/units/merge_run.h"

namespace sgs::tb {
namespace {

void random_case(Case& test) {
  std::mt19937_64& random = test.random;
  MergePlan plan;
  plan.slots = static_cast<std::uint32_t>(random() % 400);
  plan.sorters = 1 + static_cast<std::uint32_t>(random() % 4);
  plan.hfus = 1 + static_cast<std::uint32_t>(random() % 5);
  plan.input_entries = 1 + static_cast<std::uint32_t>(random() % 16);
  plan.output_entries = 1 + static_cast<std::uint32_t>(random() % 6);
  plan.config.entries = 2 + static_cast<std::uint32_t>(random() % (random() % 2 == 0 ? 20 : 400));
  plan.config.cycles_per_operation = 2 + static_cast<std::uint32_t>(random() % 3);
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
  MergeRun run(test, still_bench(plan), plan);
  add_sorters(run, plan);
  run.bench.add_thread("reader", [&](Activity& activity) {
    // FIFO in, n in and the mark beside the heap, the first out, FIFO out. Where there is none, the
    // visit's mark, that of the group, and the same out.
    std::uint64_t due = 1 + n * cycles_per_operation + (n > 0 ? 1 : 3) + 1;
    run.bench.wait_until_just_before(due);
    run.bench.checks().that(!run.outputs[0]->can_pop(), "released a cycle too soon");
    for (std::uint32_t i = 0; i <= n; ++i) {
      run.outputs[0]->pop(activity);
      run.bench.checks().equal(run.bench.clock().now_cycles(), due, "time of a key");
      due += i + 1 < n ? cycles_per_operation : 2;
    }
  });
  run.bench.run();
}

// Final keys come out although nothing more goes in; keys that tie with the bound do not.
void final_keys_do_not_wait(Case& test) {
  MergePlan plan;
  plan.slots = 4;
  plan.sorters = plan.hfus = 1;
  plan.groups.emplace_back();
  MergeRun run(test, still_bench(plan), plan);
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
  MergeRun run(test, still_bench(plan), plan);
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
               const std::function<void(MergeRun&)>& also) {
  MergePlan plan;
  plan.slots = n;
  plan.config.entries = entries;
  plan.config.spill_runs = 3;
  plan.groups.push_back(one_visit(n, tied));
  run_plan(test, still_bench(plan), plan, [&](MergeRun& run) {
    // All of it waits before the first is final, as far as there is room.
    run.bench.check_counter("pending_keys_max", std::min(n, entries));
    also(run);
  });
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
  const auto spills = [](MergeRun& run) {
    run.bench.checks().that(run.bench.counter("runs_spilled") > 0, "nothing was spilled");
  };
  const auto merges_runs = [](MergeRun& run) {
    const MergeUnit::Counters& c = run.unit.counters();
    run.bench.checks().that(c.runs_spilled > 3, "runs were not merged");
    run.bench.checks().that(c.keys_spilled > c.keys / 2, "too few keys were spilled");
  };
  const auto fits = [](MergeRun& run) {
    run.bench.check_counter("runs_spilled", 0);
    run.bench.check_counter("ties", 0);
  };
  const auto add = [&](const char* name, std::uint32_t n, std::uint32_t entries, bool tied,
                       const std::function<void(MergeRun&)>& also) {
    runner.add_directed(name, [=](Case& test) { one_group(test, n, entries, tied, also); });
  };
  add("keys that all fit", 100, 100, false, fits);
  add("one key more than fits", 101, 100, false, spills);
  add("many runs, merged in DRAM", 700, 20, false, merges_runs);
  add("capacity of two keys", 60, 2, false, merges_runs);
  add("all keys at one depth", 300, 300, true, [](MergeRun&) {});
  add("all keys at one depth, spilled", 300, 20, true, spills);
  add("all keys at one depth, capacity of two keys", 40, 2, true, spills);
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
    run_plan(test, still_bench(plan), plan, [](MergeRun& run) {
      run.bench.checks().that(run.bench.counter("forced_early") > 0, "nothing was forced out");
    });
  });
  runner.add_directed("bytes of a spill: keys out and back", [](Case& test) {
    MergePlan plan;
    plan.slots = 70;
    plan.config.entries = 64;
    plan.groups.push_back(one_visit(70, false));
    MergeRun run(test, still_bench(plan), plan);
    add_sorters(run, plan);
    add_reader(run, plan);
    run.bench.run();
    // 64 wait: an eighth goes, 8 keys, and the other 6 fit.
    run.bench.check_counter("keys_spilled", 8);
    run.bench.check_counter("runs_spilled", 1);
    test.checks.equal(run.bench.bytes_written(), std::uint64_t{8 * kBytesOfKey}, "bytes written");
    test.checks.equal(run.bench.bytes_read(), std::uint64_t{8 * kBytesOfKey}, "bytes read");
    // For each key that comes back, the fronts of all runs are looked at.
    run.bench.check_accesses("fronts of runs", plan.config.spill_runs * 8, 8);
    for (const char* use : {"rest of fronts", "spilled runs", "spill blocks"}) {
      run.bench.check_accesses(use, 8, 8);
    }
  });
  for (const std::uint32_t n : {0U, 1U, 2U, 16U, 100U}) {
    for (const std::uint32_t cycles : {2U, 3U, 4U}) {
      runner.add_directed(fmt::format("time of {} keys, an operation every {} cycles", n, cycles),
                          [=](Case& test) { exact_time(test, n, cycles); });
    }
  }
  runner.set_random(random_case);
  return runner.run(argc, argv);
}
