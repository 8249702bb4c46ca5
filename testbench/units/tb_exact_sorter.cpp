// Sorting unit of exact order alone: the keys of chunks from several HFUs in, each chunk's in order
// of depth, then slot, out. Checked against std::sort; busy cycles and times against the sorting
// network's cost.
#include <algorithm>

#include "modules/streaminggs/sorting/exact_sorter.h"
#include "modules/streaminggs/sorting/sorting_cost.h"
#include "testbench/units/case_runner.h"
#include "testbench/units/unit_bench.h"

namespace sgs::tb {
namespace {

struct Plan {
  SortingNetworkConfig config;
  std::uint32_t hfus = 3, first_visit = 0, visit_step = 2;
  std::uint32_t input_entries = 16, output_entries = 16;
  std::vector<std::vector<FineCandidate>> visits;  // this unit's, each with its mark at the end
};

std::uint32_t number_of(const Plan& plan, std::size_t k) {
  return plan.first_visit + static_cast<std::uint32_t>(k) * plan.visit_step;
}

std::vector<FineCandidate> make_visit(std::mt19937_64& random, const Plan& plan, std::size_t n,
                                      std::uint32_t depths, Mark mark) {
  std::vector<FineCandidate> visit(n + 1);
  for (std::size_t i = 0; i <= n; ++i) {
    visit[i].visit = number_of(plan, plan.visits.size());
    visit[i].group = visit[i].visit / 7;
    visit[i].slot = static_cast<std::uint32_t>(n - i);  // descends: ties must be put in order
    visit[i].depth = 0.5F + static_cast<float>(random() % depths);
    visit[i].mean_x = static_cast<float>(i);
  }
  visit[n].mark = mark;
  visit[n].release_below = 3.25F;
  return visit;
}

std::vector<FineCandidate> sorted(std::vector<FineCandidate> visit) {
  std::sort(visit.begin(), visit.end() - 1, [](const FineCandidate& a, const FineCandidate& b) {
    return a.depth < b.depth || (a.depth == b.depth && a.slot < b.slot);
  });
  return visit;
}

bool same(const FineCandidate& a, const FineCandidate& b) {
  return a.group == b.group && a.visit == b.visit && a.slot == b.slot && a.depth == b.depth &&
         a.mean_x == b.mean_x && a.mark == b.mark && a.release_below == b.release_below;
}

void run_plan(Case& test, const BenchConfig& config, const Plan& plan) {
  UnitBench bench(test, config);
  Checks& checks = bench.checks();
  const auto inputs = bench.add_fifos<FineCandidate>("from_hfu", plan.hfus, plan.input_entries, 1);
  auto& output = bench.add_fifo<FineCandidate>("sorted", plan.output_entries, 1);
  const StreamingJob job;  // nothing of it is of interest
  ExactSorter unit("sorter", plan.config, plan.first_visit, plan.visit_step, bench.context(job));
  for (TimedFifo<FineCandidate>* input : inputs) unit.keys(*input);
  unit.sorted(output);
  bench.add_unit(unit);
  for (std::uint32_t h = 0; h < plan.hfus; ++h) {
    bench.add_thread(fmt::format("hfu{}", h), [&, h](Activity& activity) {
      for (std::size_t k = 0; k < plan.visits.size(); ++k) {
        if (number_of(plan, k) % plan.hfus != h) continue;
        for (const FineCandidate& key : plan.visits[k]) inputs[h]->push(key, activity);
      }
    });
  }
  bench.add_thread("merge", [&](Activity& activity) {
    for (std::size_t k = 0; k < plan.visits.size(); ++k) {
      for (const FineCandidate& expected : sorted(plan.visits[k])) {
        const FineCandidate got = output.pop(activity);
        checks.that(
            same(got, expected),
            fmt::format("visit {}: slot {} at depth {}, expected {} at {}", number_of(plan, k),
                        got.slot, got.depth, expected.slot, expected.depth));
      }
    }
  });
  bench.run();
  std::uint64_t keys = 0, trivial = 0, busy = 0, exchanges = 0, moves = 0;
  for (const auto& visit : plan.visits) {
    const std::uint64_t n = visit.size() - 1;
    keys += n;
    trivial += n == 1 ? 1 : 0;
    busy += 2 * n + sort_cost(plan.config, n).cycles + 1;  // in, sort, out; the mark
    exchanges += sort_cost(plan.config, n).compare_exchanges;
    moves += sort_cost(plan.config, n).moves;
  }
  bench.check_counter("visits", plan.visits.size());
  bench.check_counter("visits_trivial", trivial);
  bench.check_counter("keys", keys);
  bench.check_counter("compare_exchanges", exchanges);
  bench.check_counter("moves", moves);
  bench.check_operations("sorting", "comparator", kSortKeyComparators * exchanges);
  bench.check_operations("sorting", "exchange_bit",
                         exchanged_bits(bench.context(job).built_for.chunk_gaussians) * exchanges);
  bench.check_accesses("key sorters", keys, keys);
  bench.check_accesses(kComparedKeys, keys + moves, keys);
  bench.check_accesses(kSortedPlaces, keys + moves, moves);
  checks.equal(bench.busy_cycles("sorting"), busy, "busy cycles");
}

void random_case(Case& test) {
  std::mt19937_64& random = test.random;
  Plan plan;
  plan.hfus = 1 + static_cast<std::uint32_t>(random() % 5);
  plan.visit_step = 1 + static_cast<std::uint32_t>(random() % 4);
  plan.first_visit = static_cast<std::uint32_t>(random() % plan.visit_step);
  plan.input_entries = 1 + static_cast<std::uint32_t>(random() % 20);
  plan.output_entries = 1 + static_cast<std::uint32_t>(random() % 20);
  plan.config.skip_trivial = random() % 2 == 0;
  plan.config.sort_latency_cycles = 1 + static_cast<std::uint32_t>(random() % 9);
  plan.config.merge_interval_cycles = 1 + static_cast<std::uint32_t>(random() % 4);
  constexpr std::size_t kLengths[] = {1, 2, 17, 300};
  constexpr std::uint32_t kDepths[] = {1, 4, 100000};
  for (std::size_t left = random() % 30; left > 0; --left) {
    const bool end = random() % 5 == 0;
    plan.visits.push_back(make_visit(random, plan, end ? 0 : random() % kLengths[random() % 4],
                                     kDepths[random() % 3],
                                     end ? Mark::kEndOfGroup : Mark::kEndOfVisit));
  }
  run_plan(test, random_bench(random, 4096), plan);
}

// n keys that wait at the input: the first is out after the FIFO, n cycles in, the network and one
// cycle out, and not a cycle sooner; then one a cycle.
void exact_time(Case& test, std::size_t n) {
  Plan plan;
  plan.visits.push_back(make_visit(test.random, plan, n, 10, Mark::kEndOfVisit));
  BenchConfig config;
  UnitBench bench(test, config);
  auto& input = bench.add_fifo<FineCandidate>("input", static_cast<std::uint32_t>(n + 1), 1);
  auto& output = bench.add_fifo<FineCandidate>("output", static_cast<std::uint32_t>(n + 1), 1);
  const StreamingJob job;
  ExactSorter unit("sorter", plan.config, 0, 1, bench.context(job));
  unit.keys(input);
  unit.sorted(output);
  bench.add_unit(unit);
  bench.add_thread("hfu", [&](Activity& activity) {
    for (const FineCandidate& key : plan.visits[0]) input.push(key, activity);
  });
  const std::uint64_t first = 1 + n + sort_cost(plan.config, n).cycles + 1 + 1;
  bench.add_thread("merge", [&](Activity& activity) {
    bench.wait_until_just_before(first);
    bench.checks().that(!output.can_pop(), "done a cycle too soon");
    for (std::size_t i = 0; i < n; ++i) {
      output.pop(activity);
      bench.checks().equal(bench.clock().now_cycles(), first + i, "time of a key");
    }
    output.pop(activity);
    bench.checks().equal(bench.clock().now_cycles(), first + n, "the mark");
  });
  bench.run();
}

}  // namespace
}  // namespace sgs::tb

int sc_main(int argc, char* argv[]) {
  using namespace sgs;
  using namespace sgs::tb;
  CaseRunner runner("tb_exact_sorter",
                    "Sorting unit of exact order alone, against std::sort by depth and slot");
  for (const std::size_t n : {0U, 1U, 2U, 16U, 17U, 64U, 256U}) {
    runner.add_directed(fmt::format("time of {} keys", n),
                        [n](Case& test) { exact_time(test, n); });
  }
  runner.add_directed("equal depths", [](Case& test) {
    Plan plan;
    for (const std::size_t n : {300U, 2U, 16U}) {
      plan.visits.push_back(make_visit(test.random, plan, n, 1, Mark::kEndOfVisit));
    }
    run_plan(test, {}, plan);
  });
  runner.add_directed("marks only", [](Case& test) {
    Plan plan;
    for (int k = 0; k < 9; ++k) {
      plan.visits.push_back(make_visit(test.random, plan, 0, 1, Mark::kEndOfGroup));
    }
    run_plan(test, {}, plan);
  });
  runner.set_random(random_case);
  return runner.run(argc, argv);
}
