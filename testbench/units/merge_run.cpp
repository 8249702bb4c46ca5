// Checked against std::sort by (depth, slot); cycles, bytes and conservation.
#include "testbench/units/merge_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "testbench/units/job_memory.h"

namespace sgs::tb {
namespace {

bool same_payload(const FineCandidate& a, const FineCandidate& b) {
  return a.slot == b.slot && a.depth == b.depth && a.mean_x == b.mean_x && a.mean_y == b.mean_y &&
         a.mean_z == b.mean_z && a.carried == b.carried;
}

// For visits as long as the plan's.
UnitContext merge_context(const UnitBench& bench, const StreamingJob& job, const MergePlan& plan) {
  UnitContext context = bench.context(job);
  context.built_for.chunk_gaussians = longest_visit(plan);
  context.built_for.group = square_of(16);
  return context;
}

// Keys released behind one of the same depth.
std::uint64_t tied_keys(const MergePlan& plan, const MergeGroup& group) {
  const std::vector<MergeKey> keys = expected_order(plan, group);
  std::uint64_t tied = 0;
  for (std::size_t k = 1; k < keys.size(); ++k) tied += keys[k].depth == keys[k - 1].depth ? 1 : 0;
  return tied;
}

// blend_early: keys that go after a visit although a later one might have sent a nearer key.
std::uint64_t forced_keys(const MergePlan& plan, const MergeGroup& group) {
  std::uint64_t forced = 0;
  std::multiset<float> waiting;
  for (const MergeVisit& visit : group.visits) {
    for (const MergeKey& key : visit.keys) waiting.insert(key.depth);
    waiting.erase(waiting.begin(), waiting.lower_bound(visit.release_below));
    for (; waiting.size() > plan.config.entries; ++forced) waiting.erase(waiting.begin());
  }
  return forced;
}

// By the bytes that went out and came back. A key passes a block on its way out; back, the blocks
// of its run, then it is the front of that run, which is looked at whenever any front leaves.
void check_spill_memories(MergeRun& run, const MergePlan& plan, bool saturating) {
  if (plan.config.on_overflow != OnOverflow::kSpill) return;
  const std::uint64_t out = run.bench.bytes_written() / kBytesOfKey;
  run.bench.check_accesses("spill blocks", out, out);
  // Some keys of a finished group never come back.
  if (saturating) return;
  const std::uint64_t back = run.bench.bytes_read() / kBytesOfKey;
  run.bench.check_accesses("spilled runs", back, back);
  run.bench.check_accesses("fronts of runs", plan.config.spill_runs * back, back);
  run.bench.check_accesses("rest of fronts", back, back);
}

void check_counters(MergeRun& run, const MergePlan& plan) {
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
  // A cycle for a key that comes, one that is due and one that goes to DRAM, for a mark and for the
  // end of a group that goes on; beside them the heap's own pace.
  const HeapWork& heap = run.unit.heap_work();
  run.bench.check_counter("inserts", heap.inserts);
  run.bench.check_counter("delete_mins", heap.delete_mins);
  run.bench.check_counter("delete_maxs", heap.delete_maxs);
  std::uint64_t passing = c.keys + c.due + c.keys_spilled + 2 * plan.groups.size();
  for (const MergeGroup& group : plan.groups) passing += group.visits.size();
  const std::uint64_t busy = run.bench.busy_cycles("merge");
  checks.that(busy >= passing, "what passes takes less than a cycle each");
  checks.that(busy <= passing + (plan.config.cycles_per_operation - 1) * heap.operations(),
              "more than the heap's pace");
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
    std::uint64_t forced = 0;
    for (const MergeGroup& group : plan.groups) forced += forced_keys(plan, group);
    if (!saturating) run.bench.check_counter("forced_early", forced);
  }
  // A word a node, the root's in each operation; a level passes no more nodes than operations.
  run.bench.check_accesses("waiting keys 0", heap.operations(), heap.operations());
  std::uint64_t read = 0, written = 0;
  for (std::size_t level = 1; level < heap.levels.size(); ++level) {
    const HeapLevelWork& of = heap.levels[level];
    const std::uint64_t ahead = plan.config.cycles_per_operation == 2 ? of.nodes_read_ahead : 0;
    run.bench.check_accesses("waiting keys " + std::to_string(level), of.nodes_read + ahead,
                             of.nodes_written);
    checks.that(of.nodes_written <= heap.operations(), "a level is written twice by an operation");
    read += of.nodes_read;
    written += of.nodes_written;
  }
  run.bench.check_counter("heap_nodes_read", read);
  run.bench.check_counter("heap_nodes_written", written);
  // A key is depth and slot.
  std::uint64_t comparisons = 2 * run.bench.counter("heap_comparisons");
  comparisons += 4 * c.due;  // 4 rows of 4 sub-tiles, of 16 px
  run.bench.check_accesses("finished sub-tiles", 32 * c.due, run.mask.news());  // 4 rows of a byte
  if (plan.config.on_overflow == OnOverflow::kSpill) {
    comparisons += 2 * (plan.config.spill_runs - 1) * run.bench.counter("keys_spilled");
  }
  run.bench.check_operations("merge", "comparator", comparisons);
  check_spill_memories(run, plan, saturating);
  // Nothing went past the spill area.
  const RegionSpan& spill = run.job.spill;
  const std::vector<std::byte> behind =
      run.bench.read_back(spill.end(), run.job.frame_buffer.end() - spill.end());
  checks.that(
      std::all_of(behind.begin(), behind.end(), [](std::byte b) { return b == std::byte{}; }),
      "written past the spill area");
}

}  // namespace

MergeRun::MergeRun(Case& test, const BenchConfig& config, const MergePlan& plan)
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
  unit.masks(mask);
  bench.add_unit(unit);
}

void add_sorters(MergeRun& run, const MergePlan& plan) {
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

void add_reader(MergeRun& run, const MergePlan& plan) {
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

void run_plan(Case& test, const BenchConfig& config, const MergePlan& plan,
              const std::function<void(MergeRun&)>& also) {
  MergeRun run(test, config, plan);
  add_sorters(run, plan);
  add_reader(run, plan);
  run.bench.run();
  check_counters(run, plan);
  also(run);
}

BenchConfig still_bench(const MergePlan& plan) {
  BenchConfig config;
  config.memory_bytes = memory_bytes(merge_job(plan));
  return config;
}

}  // namespace sgs::tb
