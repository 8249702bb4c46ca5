// Sorting unit of paper order alone: lists of visits from several HFUs, sorted lists out. Checked
// against std::sort by (depth, index); busy cycles against the passes counted here; spilled bytes.
#include <algorithm>

#include "algorithm/memory/splat_record.h"
#include "modules/streaminggs/sorting/paper_sorter.h"
#include "modules/streaminggs/sorting/sorting_cost.h"
#include "testbench/units/case_runner.h"
#include "testbench/units/job_memory.h"
#include "testbench/units/random_scene.h"
#include "testbench/units/unit_bench.h"

namespace sgs::tb {
namespace {

struct Visit {
  std::uint32_t group = 0;
  Mark end = Mark::kEndOfVisit;
  std::vector<std::vector<Splat>> from_hfu;  // [HFU]
  bool finishes_group = false;  // the reader reports the group as finished within this visit
};

struct Plan {
  PaperSorterConfig config;
  NumberFormat splats = NumberFormat::kSingle;
  StreamingJob job;
  std::uint32_t hfus = 1;
  std::uint32_t first_visit = 0, visit_step = 1;
  std::uint32_t input_entries = 4, output_entries = 8, input_latency_cycles = 1;
  std::uint32_t feedback_cycles = 1;
  std::vector<Visit> visits;  // those of this unit
};

// Operations for one list, counted from the description of the unit: runs of a buffer each, merged
// fan_in at a time.
struct Work {
  std::uint64_t busy_cycles = 0, entries_spilled = 0, runs = 0;
  std::uint64_t compare_exchanges = 0, moves = 0;
};

Work expected_work(const PaperSorterConfig& config, std::uint64_t n) {
  Work work;
  std::vector<std::uint64_t> runs;
  for (std::uint64_t left = n; left > 0; left -= runs.back()) {
    runs.push_back(std::min<std::uint64_t>(left, config.buffer_entries));
    const SortingCost cost = sort_cost(config, runs.back());
    work.busy_cycles += cost.cycles;
    work.compare_exchanges += cost.compare_exchanges;
    work.moves += cost.moves;
  }
  work.busy_cycles += 2 * n;  // one cycle in, one cycle out
  if (runs.size() < 2) return work;
  work.runs = runs.size();
  work.busy_cycles += n;  // the first time into DRAM
  work.entries_spilled = n;
  const std::size_t fan_in = std::max(2U, config.buffer_entries / (2 * config.spill_block_entries));
  // An entry goes through the network once a level of the tree; of the 16 that a merge compares in
  // each of its 4 stages by 8 comparators, 8 are given.
  const auto merge = [&](std::uint64_t entries, std::size_t count) {
    std::uint64_t levels = 0;
    for (std::size_t runs_left = count; runs_left > 1; runs_left = (runs_left + 1) / 2) ++levels;
    work.busy_cycles += entries * merge_tree_cycles(config, count) / kMergeWidth;
    work.moves += entries * levels;
    work.compare_exchanges += entries * levels * 4;
  };
  while (runs.size() > fan_in) {
    std::vector<std::uint64_t> longer;
    for (std::size_t at = 0; at < runs.size(); at += fan_in) {
      const std::size_t count = std::min(fan_in, runs.size() - at);
      std::uint64_t entries = 0;
      for (std::size_t k = 0; k < count; ++k) entries += runs[at + k];
      merge(entries, count);
      work.entries_spilled += entries;
      longer.push_back(entries);
    }
    runs = longer;
  }
  merge(n, runs.size());
  return work;
}

std::vector<Splat> sorted(const Visit& visit, NumberFormat format) {
  std::vector<Splat> all;
  for (const auto& part : visit.from_hfu) {
    for (const Splat& splat : part) all.push_back(rounded_splat(format, splat));
  }
  std::sort(all.begin(), all.end(), in_front);
  return all;
}

// A key is written as its entry comes, read for each pass and as the entry goes; its place
// likewise, but for the first, which is known. Each key of a pass comes from one of 16 banks.
void check_network(UnitBench& bench, const Plan& plan, const Work& work, std::uint64_t held) {
  bench.check_counter("compare_exchanges", work.compare_exchanges);
  bench.check_counter("moves", work.moves);
  bench.check_accesses(kComparedKeys, held + work.moves, held);
  bench.check_accesses(kSortedPlaces, held + work.moves, work.moves);
  if (plan.config.buffer_entries <= kNetworkWidth) return;  // whole blocks only
  constexpr std::uint64_t kHalvings = 4;                    // halvings of 16 banks
  bench.check_operations("sorting", "select_bit",
                         kHalvings * exchanged_bits(plan.config.buffer_entries) * work.moves);
}

struct Outcome {
  std::uint64_t received = 0, handed_on = 0;
};

// One visit's tokens as they came out.
void check_visit(Checks& checks, const Plan& plan, std::uint32_t number, const Visit& visit,
                 const std::vector<Splat>& got, bool saturated) {
  const std::vector<Splat> expected = sorted(visit, plan.splats);
  if (saturated) {
    checks.that(got.size() <= expected.size(), fmt::format("visit {}: too many splats", number));
  } else {
    checks.equal(got.size(), expected.size(), fmt::format("visit {}: splats", number));
  }
  const SubtileRect group = subtiles_of(plan.job.groups[visit.group]);
  for (std::size_t i = 0; i < std::min(got.size(), expected.size()); ++i) {
    const std::string differs = difference(got[i], expected[i], group);
    checks.that(differs.empty(), fmt::format("visit {}, splat {}: {}", number, i, differs));
  }
}

void run_plan(Case& test, const BenchConfig& bench_config, const Plan& plan) {
  UnitBench bench(test, bench_config);
  FinishedGroups finished("finished", bench.clock(), plan.job.groups.size(), plan.feedback_cycles);
  const auto inputs = bench.add_fifos<SplatToken>("from_hfu", plan.hfus, plan.input_entries,
                                                  plan.input_latency_cycles);
  auto& output = bench.add_fifo<SplatToken>("sorted", plan.output_entries, 1);
  UnitContext context = bench.context(plan.job);
  context.built_for.splats = plan.splats;
  PaperSorter unit("sorting", plan.config, {plan.first_visit, plan.visit_step, plan.job.spill},
                   context);
  for (TimedFifo<SplatToken>* input : inputs) unit.splats(*input);
  unit.sorted(output);
  unit.finished(finished);
  bench.add_unit(unit);

  const auto number_of = [&](std::size_t k) {
    return plan.first_visit + static_cast<std::uint32_t>(k) * plan.visit_step;
  };
  for (std::uint32_t h = 0; h < plan.hfus; ++h) {
    bench.add_thread(fmt::format("hfu{}", h), [&, h](Activity& activity) {
      for (std::size_t k = 0; k < plan.visits.size(); ++k) {
        const Visit& visit = plan.visits[k];
        SplatToken token;
        token.group = visit.group;
        token.visit = number_of(k);
        for (const Splat& splat : visit.from_hfu[h]) {
          token.splat = splat;
          inputs[h]->push(token, activity);
        }
        token.mark = visit.end;
        inputs[h]->push(token, activity);
      }
    });
  }
  Outcome outcome;
  bench.add_thread("reader", [&](Activity& activity) {
    for (std::size_t k = 0; k < plan.visits.size(); ++k) {
      const Visit& visit = plan.visits[k];
      std::vector<Splat> got;
      while (true) {
        const SplatToken token = output.pop(activity);
        bench.checks().equal(token.visit, number_of(k), "number of the visit");
        bench.checks().equal(token.group, visit.group, "group of the visit");
        if (token.mark != Mark::kNone) {
          bench.checks().that(token.mark == visit.end, "the mark that ends the visit");
          break;
        }
        got.push_back(token.splat);
        if (visit.finishes_group) finished.finish(visit.group, 0);
      }
      outcome.handed_on += got.size();
      check_visit(bench.checks(), plan, number_of(k), visit, got, finished.finished(visit.group));
    }
  });
  bench.run();

  Work work;
  std::uint64_t trivial = 0, longest = 0;
  bool any_saturated = false;
  for (const Visit& visit : plan.visits) {
    std::uint64_t n = 0;
    for (const auto& part : visit.from_hfu) n += part.size();
    outcome.received += n;
    trivial += n == 1 ? 1 : 0;
    longest = std::max(longest, n);
    any_saturated = any_saturated || finished.finished(visit.group);
    const Work of_visit = expected_work(plan.config, n);
    work.busy_cycles += of_visit.busy_cycles + plan.hfus + 1;  // marks in, mark out
    work.entries_spilled += of_visit.entries_spilled;
    work.runs += of_visit.runs;
    work.compare_exchanges += of_visit.compare_exchanges;
    work.moves += of_visit.moves;
  }
  Checks& checks = bench.checks();
  bench.check_counter("visits", plan.visits.size());
  bench.check_counter("visits_trivial", trivial);
  bench.check_counter("splats", outcome.received);
  bench.check_counter("list_max", longest);
  const std::uint64_t exchanges = bench.counter("compare_exchanges");
  bench.check_operations("sorting", "comparator", kSortKeyComparators * exchanges);
  bench.check_operations("sorting", "exchange_bit",
                         exchanged_bits(plan.config.buffer_entries) * exchanges);
  bench.check_counter("splats_saturated", outcome.received - outcome.handed_on);
  if (any_saturated) return;
  checks.equal(bench.busy_cycles("sorting"), work.busy_cycles, "busy cycles");
  bench.check_counter("entries_spilled", work.entries_spilled);
  bench.check_counter("runs_spilled", work.runs);
  // Spilled entries pass a block on their way out. They came into the buffer and left it before,
  // and do so again when they are read back.
  const std::uint64_t held = outcome.received + work.entries_spilled;
  bench.check_accesses("spill blocks", work.entries_spilled, work.entries_spilled);
  bench.check_accesses("sort buffers", held, held);
  check_network(bench, plan, work, held);
  const std::uint32_t entry = splat_entry_bytes(plan.splats);
  checks.equal(bench.bytes_written(), work.entries_spilled * entry, "bytes written");
  checks.equal(bench.bytes_read(), work.entries_spilled * entry, "bytes read");
}

// The longest list that a plan's spill area holds.
constexpr std::uint64_t kLongestList = 2000;

Plan small_plan(int width_px = 64, int height_px = 48, int side_px = 32) {
  Plan plan;
  plan.job = frame_job(width_px, height_px, square_of(side_px), FrameFormat::kRgb8,
                       2 * kLongestList * kSplatEntryBytes);
  return plan;
}

Visit make_visit(std::mt19937_64& random, const Plan& plan, std::uint32_t group, std::size_t n) {
  Visit visit;
  visit.group = group;
  visit.from_hfu.resize(plan.hfus);
  for (std::size_t i = 0; i < n; ++i) {
    // Indices descend: equal depths must be put in order by them.
    const Splat splat = random_splat(random, plan.job.groups[group], plan.job,
                                     static_cast<std::uint32_t>(n - i), 1.0F);
    visit.from_hfu[random() % plan.hfus].push_back(splat);
  }
  return visit;
}

void random_case(Case& test) {
  std::mt19937_64& random = test.random;
  Plan plan = small_plan(1 + static_cast<int>(random() % 100), 1 + static_cast<int>(random() % 60),
                         4 * (1 + static_cast<int>(random() % 20)));
  plan.hfus = 1 + static_cast<std::uint32_t>(random() % 5);
  plan.splats = random() % 2 == 0 ? NumberFormat::kSingle : NumberFormat::kHalf;
  plan.visit_step = 1 + static_cast<std::uint32_t>(random() % 3);
  plan.first_visit = static_cast<std::uint32_t>(random() % plan.visit_step);
  plan.input_entries = 1 + static_cast<std::uint32_t>(random() % 6);
  plan.output_entries = 1 + static_cast<std::uint32_t>(random() % 6);
  plan.input_latency_cycles = static_cast<std::uint32_t>(random() % 40);
  plan.config.spill_block_entries = 1 + static_cast<std::uint32_t>(random() % 4);
  plan.config.buffer_entries = 16 + static_cast<std::uint32_t>(random() % 64);
  plan.config.skip_trivial = random() % 2 == 0;
  plan.config.merge_interval_cycles = 1 + static_cast<std::uint32_t>(random() % 4);
  plan.config.sort_interval_cycles = 1 + static_cast<std::uint32_t>(random() % 3);
  constexpr std::size_t kLengths[] = {0, 1, 2, 40, 400};
  const bool saturating = random() % 3 == 0;
  for (std::uint32_t group = 0; group < plan.job.groups.size() && plan.visits.size() < 25;
       ++group) {
    for (std::size_t left = random() % 6; left > 0; --left) {
      plan.visits.push_back(
          make_visit(random, plan, group, random() % (kLengths[random() % 5] + 1)));
      plan.visits.back().finishes_group = saturating && random() % 4 == 0;
    }
    plan.visits.push_back(make_visit(random, plan, group, 0));
    plan.visits.back().end = Mark::kEndOfGroup;
  }
  plan.feedback_cycles = 1 + static_cast<std::uint32_t>(random() % 60);
  run_plan(test, random_bench(random, memory_bytes(plan.job)), plan);
}

// n splats that all wait at the input: the first sorted one is there after n cycles in, the
// network's cycles and one cycle out, and not a cycle sooner.
void exact_time(Case& test, std::size_t n) {
  Plan plan = small_plan();
  const Visit visit = make_visit(test.random, plan, 0, n);
  UnitBench bench(test, still_bench(memory_bytes(plan.job)));
  FinishedGroups finished("finished", bench.clock(), plan.job.groups.size(), 1);
  auto& input = bench.add_fifo<SplatToken>("from_hfu0", static_cast<std::uint32_t>(n + 1), 1);
  auto& output = bench.add_fifo<SplatToken>("sorted", 64, 1);
  PaperSorter unit("sorting", plan.config, {0, 1, plan.job.spill}, bench.context(plan.job));
  unit.splats(input);
  unit.sorted(output);
  unit.finished(finished);
  bench.add_unit(unit);
  bench.add_thread("hfu0", [&](Activity& activity) {
    SplatToken token;
    for (const Splat& splat : visit.from_hfu[0]) {
      token.splat = splat;
      input.push(token, activity);
    }
    token.mark = Mark::kEndOfGroup;
    input.push(token, activity);
  });
  // Input latency, n and the mark in, sort, first out (of an empty list the mark), output latency.
  const std::uint64_t cost = sort_cost(plan.config, n).cycles;
  const std::uint64_t first = 1 + n + 1 + cost + 1 + 1;
  bench.add_thread("reader", [&](Activity& activity) {
    bench.wait_until_just_before(first);
    bench.checks().that(!output.can_pop(), "done a cycle too soon");
    output.pop(activity);
    bench.checks().equal(bench.clock().now_cycles(), first, "first entry");
    for (std::size_t i = 0; i < n; ++i) output.pop(activity);
    // One a cycle, and the mark.
    bench.checks().equal(bench.clock().now_cycles(), first + n, "last entry");
  });
  bench.run();
}

void one_list(Case& test, std::uint32_t group, std::size_t n, const PaperSorterConfig& config,
              float depth_step, NumberFormat splats = NumberFormat::kSingle) {
  Plan plan = small_plan();
  plan.config = config;
  plan.splats = splats;
  plan.visits.push_back(make_visit(test.random, plan, group, n));
  for (auto& part : plan.visits.back().from_hfu) {
    for (Splat& splat : part) splat.depth *= depth_step;
  }
  plan.visits.push_back(make_visit(test.random, plan, group, 0));
  plan.visits.back().end = Mark::kEndOfGroup;
  run_plan(test, still_bench(memory_bytes(plan.job)), plan);
}

}  // namespace
}  // namespace sgs::tb

int sc_main(int argc, char* argv[]) {
  using namespace sgs;
  using namespace sgs::tb;
  CaseRunner runner("tb_paper_sorter",
                    "Sorting unit of paper order alone, against std::sort by depth and index");
  PaperSorterConfig small;
  small.buffer_entries = 16;
  const auto add = [&](const char* name, std::uint32_t group, std::size_t n,
                       const PaperSorterConfig& config, float depth_step) {
    runner.add_directed(name, [=](Case& test) { one_list(test, group, n, config, depth_step); });
  };
  // With visits of its own, the last of which ends the last of their groups.
  const auto plan_with = [&](const char* name, const Plan& plan, auto fill) {
    runner.add_directed(name, [=](Case& test) {
      Plan own = plan;
      fill(own, test.random);
      own.visits.back().end = Mark::kEndOfGroup;
      run_plan(test, still_bench(memory_bytes(own.job)), own);
    });
  };
  Plan of_four = small_plan();
  of_four.hfus = 4;
  plan_with("marks only", of_four, [](Plan& plan, std::mt19937_64& random) {
    for (std::uint32_t group = 0; group < plan.job.groups.size(); ++group) {
      plan.visits.push_back(make_visit(random, plan, group, 0));
      plan.visits.back().end = Mark::kEndOfGroup;
    }
  });
  const PaperSorterConfig usual;
  const std::size_t full = usual.buffer_entries;
  add("one splat", 0, 1, usual, 1);
  add("a full buffer", 0, full, usual, 1);
  // The second run is read back as soon as it has been written.
  add("one more than the buffer", 0, full + 1, usual, 1);
  add("equal depths", 1, 50, usual, 0);
  add("equal depths, spilled", 1, 200, small, 0);
  // 16 entries, blocks of 4: two runs at a time; 63 runs take six passes.
  add("several merge passes", 0, 1000, small, 1);
  // Rounded once, however often an entry is spilled.
  runner.add_directed("several merge passes of halves", [=](Case& test) {
    one_list(test, 0, 1000, small, 1, NumberFormat::kHalf);
  });
  add("group cut by the frame's edge", 3, 300, small, 1);
  Plan pixel = small_plan(1, 1, 64), several = small_plan();
  pixel.config = several.config = small;
  plan_with("1x1 frame", pixel, [](Plan& plan, std::mt19937_64& random) {
    plan.visits.push_back(make_visit(random, plan, 0, 100));
  });
  plan_with("group finished while a list is merged", several,
            [](Plan& plan, std::mt19937_64& random) {
              for (int k = 0; k < 3; ++k) {
                plan.visits.push_back(make_visit(random, plan, 0, 500));
                plan.visits.back().finishes_group = true;
              }
            });
  for (const std::size_t n : {0, 1, 2, 16, 17, 32, 33, 64}) {
    runner.add_directed(fmt::format("time of {} splats", n),
                        [n](Case& test) { exact_time(test, n); });
  }
  runner.set_random(random_case);
  return runner.run(argc, argv);
}
