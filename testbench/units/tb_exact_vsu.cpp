// Voxel sorting unit in exact order, alone: the chunk tree in memory, visits out to several HFUs.
// Checked against all chunks below nodes that touch a group, sorted by depth; cycles and bytes
// against the counts of those nodes.
#include <algorithm>
#include <limits>

#include "modules/datapath/group_numbers.h"
#include "testbench/units/case_runner.h"
#include "testbench/units/exact_vsu_plan.h"
#include "testbench/units/job_memory.h"
#include "testbench/units/reported_groups.h"
#include "testbench/units/unit_bench.h"

namespace sgs::tb {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// One group's visits, [first, end) of all that came out, and its end at `end`.
void check_group(Checks& checks, std::uint32_t group, const std::vector<WalkEntry>& expected,
                 const std::vector<VisitShare>& received, std::size_t first, std::size_t end,
                 bool saturated) {
  const std::size_t visits = end - first;
  if (saturated) {
    checks.that(visits <= expected.size(), fmt::format("group {}: too many visits", group));
  } else {
    checks.equal(visits, expected.size(), fmt::format("group {}: visits", group));
  }
  for (std::size_t k = 0; k < std::min(visits, expected.size()); ++k) {
    const VisitShare& got = received[first + k];
    const float below = k + 1 < expected.size() ? expected[k + 1].nearest : kInfinity;
    checks.that(got.mark == Mark::kEndOfVisit && got.group == group && got.visit == first + k,
                fmt::format("group {}, visit {}: group, number or mark", group, k));
    checks.equal(got.first, expected[k].at, fmt::format("group {}, visit {}: slot", group, k));
    checks.equal(got.count, expected[k].count, fmt::format("group {}, visit {}: count", group, k));
    checks.equal(got.release_below, below, fmt::format("group {}, visit {}: release", group, k));
  }
  const VisitShare& mark = received[end];
  checks.that(
      mark.mark == Mark::kEndOfGroup && mark.group == group && mark.visit == end && mark.count == 0,
      fmt::format("group {}: end", group));
}

// Visits [first, end) of a group and its end, and the cycles in which they came: one goes out only
// while the group is not seen as finished, and when the group ends without the rest it is.
void check_left_out(Checks& checks, const ReportedGroups& groups, std::uint32_t group,
                    std::size_t first, std::size_t end, const std::vector<std::uint64_t>& cycles,
                    std::size_t all) {
  constexpr std::uint64_t kOnTheWay = 2;  // a cycle's work behind the decision, one in the FIFO
  for (std::size_t k = first; k + 1 < end; ++k) {
    checks.that(cycles[k] - kOnTheWay < groups.seen_from(group),
                fmt::format("group {}: visit {} although the group is finished", group, k - first));
  }
  if (end - first == all) return;
  checks.that(cycles[end] - kOnTheWay >= groups.seen_from(group),
              fmt::format("group {}: the rest is left out too soon", group));
}

// Rows of the mask for an entry that is looked up, depth and number of each open node for the
// nearest chunk; beside these the queues, two keys a level at most, and where no queue holds more
// than one entry nothing. Numbers that a test compares have comparators of their own.
void check_comparators(UnitBench& bench, const ExactVsuPlan& plan, std::uint64_t operations,
                       std::uint64_t open_keys) {
  constexpr std::uint64_t kRows = 4, kWords = 2, kOfLevel = 2;  // groups of 16 x 16 px
  const std::uint64_t least = kRows * bench.counter("looked_up") + kWords * open_keys;
  const std::uint64_t levels =
      heap_levels(std::max(plan.config.queue_entries, plan.config.node_queue_entries));
  const double done = bench.operations("vsu", "comparator");
  if (bench.counter("chunk_queue_max") <= 1 && bench.counter("node_queue_max") <= 1) {
    bench.check_operations("vsu", "comparator", least);
  }
  bench.checks().that(done >= static_cast<double>(least), "comparators: too few operations");
  bench.checks().that(done <= static_cast<double>(least + kWords * kOfLevel * levels * operations),
                      "comparators: too many operations");
}

void check_counters(UnitBench& bench, const ExactVsuPlan& plan, const ExpectedWalk& expected,
                    bool any_finished) {
  Checks& checks = bench.checks();
  const std::uint64_t put_aside = bench.counter("queue_entries_put_aside");
  const std::uint64_t aside_bytes = put_aside * kWalkEntryBytes;
  checks.equal(bench.bytes_written(), aside_bytes, "bytes put aside");
  checks.that(bench.counter("chunk_queue_max") <= plan.config.queue_entries,
              "the queue holds more than it can");
  checks.that(bench.counter("node_queue_max") <= plan.config.node_queue_entries,
              "the queue of nodes holds more than it can");
  const std::uint64_t upper =
      std::min<std::uint64_t>(plan.config.upper_nodes, plan.tree.nodes.size());
  const std::uint64_t table_bytes = (upper + bench.counter("nodes_read")) * sizeof(ChunkNode);
  checks.that(bench.bytes_read() >= table_bytes, "bytes read of the tree");
  checks.that(bench.bytes_read() <= table_bytes + aside_bytes, "bytes read of what was put aside");
  bench.check_operations("vsu", "fp32_lane", bench.counter("tests") * macs_of_a_test());
  bench.check_operations(
      "vsu", "number_comparator",
      bench.counter("tests") * comparisons_of_a_test() +
          plan.job.groups.size() * group_flow(GroupUse::kWalk).counts().comparisons);
  checks.equal(bench.counter("nodes"),
               bench.counter("upper_nodes_opened") + bench.counter("nodes_read") -
                   bench.counter("nodes_dropped"),
               "nodes opened");
  // Four accesses of 32 B a node.
  bench.check_accesses("upper nodes", 4 * bench.counter("upper_nodes_opened"), 4 * upper);
  bench.check_accesses("nodes in flight", 4 * bench.counter("nodes_read"),
                       4 * bench.counter("nodes_read"));
  // A key is written for each node that is taken and each entry put aside, and all are compared
  // with the nearest chunk whenever a queue has changed.
  const std::uint64_t operations =
      bench.counter("chunk_queue_operations") + bench.counter("node_queue_operations");
  const std::uint64_t keys = plan.config.nodes_in_flight + plan.config.nodes_in_test + 1;
  bench.check_accesses(
      "keys of open nodes", keys * operations,
      bench.counter("upper_nodes_opened") + bench.counter("nodes_read") + put_aside);
  check_comparators(bench, plan, operations, keys * operations);
  checks.equal(bench.busy_cycles("visits"),
               bench.counter("visits") + bench.counter("visits_dropped") + plan.job.groups.size(),
               "cycles of handing out or dropping visits, and of ends of groups");
  if (any_finished) return;
  bench.check_counter("visits", expected.visits);
  bench.check_counter("nodes", expected.nodes);
  bench.check_counter("upper_nodes_opened", expected.upper);
  bench.check_counter("nodes_dropped", 0);
  bench.check_counter("tests", expected.tests);
  bench.check_counter("looked_up", expected.nodes + expected.visits);
  // In as it was read, out as entries of the queues.
  bench.check_accesses("nodes in test", 2 * 4 * expected.nodes, 2 * 4 * expected.nodes);
  bench.check_counter("groups_empty", expected.empty);
  bench.check_counter("groups_saturated", 0);
  if (put_aside == 0) {
    checks.equal(bench.busy_cycles("vsu"), expected.cycles, "busy cycles");
    // The first child of a node waits for its turn at the lanes.
    const std::uint64_t testing = bench.busy_cycles("chunk_tests");
    checks.that(testing >= expected.testing_cycles, "cycles of tests: too few");
    checks.that(testing <= expected.testing_cycles + expected.turn_cycles,
                "cycles of tests: too many");
    checks.equal(operations, expected.queue_operations, "operations of the queues");
  } else {
    checks.that(bench.busy_cycles("vsu") >= operations * plan.config.cycles_per_queue_operation,
                "operations of the queues take no time");
  }
}

void run_plan(Case& test, const BenchConfig& bench_config, const ExactVsuPlan& plan) {
  const ExpectedWalk expected = expect(plan);
  UnitBench bench(test, bench_config);
  bench.load(0, plan.image.bytes);
  ReportedGroups finished(bench.clock(), plan.job.groups.size(), plan.feedback_cycles);
  for (std::uint32_t g = 0; plan.finished_before && g < plan.job.groups.size(); ++g) {
    finished.finish(g);
  }
  FinishedSubtiles mask("mask", bench.clock(), plan.job.groups, 1);
  for (std::uint32_t g = 0; g < plan.job.groups.size(); ++g) {
    const PixelRect& group = plan.job.groups[g];
    const int columns = (group.width() + kSubtilePx - 1) / kSubtilePx;
    const int rows = (group.height() + kSubtilePx - 1) / kSubtilePx;
    const int finished_here = std::min(columns, plan.finished_columns);
    for (int k = 0; k < rows * finished_here; ++k) {
      mask.finish(g, static_cast<std::size_t>(k / finished_here * columns + k % finished_here), 0);
    }
  }
  const auto visits = bench.add_fifos<VisitShare>("to_hfu", plan.hfus, plan.fifo_entries, 1);
  UnitContext context = bench.context(plan.job);
  context.built_for.group = square_of(16);
  ExactVsu unit("vsu", plan.config, context, plan.job.spill);
  for (TimedFifo<VisitShare>* fifo : visits) unit.visits(*fifo);
  unit.finished(finished.channel);
  unit.masks(mask);
  bench.add_unit(unit);
  std::vector<VisitShare> received;
  std::vector<std::uint64_t> cycles;  // in which they came
  bench.add_thread("hfus", [&](Activity& activity) {
    bench.clock().wait_cycles(plan.hfus_begin_at);
    if (plan.hfus_begin_at > 0) {
      // Nothing has left but what fills the FIFOs: the walk has gone on into the next group.
      bench.checks().that(bench.counter("nodes") > expected.nodes_of[0],
                          "the next group's walk waits for this one's visits");
    }
    for (std::size_t ends = 0; ends < plan.job.groups.size();) {
      received.push_back(visits[received.size() % plan.hfus]->pop(activity));
      cycles.push_back(bench.clock().now_cycles());
      ends += received.back().mark == Mark::kEndOfGroup ? 1 : 0;
      if (plan.saturate_one_in > 0 &&
          test.random() % static_cast<unsigned>(plan.saturate_one_in) == 0) {
        finished.finish(received.back().group);
      }
    }
    // Entries that the last group put aside may still be on their way.
    constexpr std::uint64_t kLongerThanMemoryTakes = 10'000;
    bench.clock().wait_cycles(kLongerThanMemoryTakes);
  });
  bench.run();

  std::size_t at = 0;
  std::uint64_t visits_seen = 0;
  bool any_finished = false;
  for (std::uint32_t g = 0; g < plan.job.groups.size(); ++g, ++at) {
    const std::size_t first = at;
    while (at < received.size() && received[at].mark == Mark::kEndOfVisit) ++at;
    bench.checks().that(at < received.size(), fmt::format("group {}: no end", g));
    if (at == received.size()) return;
    check_group(bench.checks(), g, expected.groups[g], received, first, at, finished.finished(g));
    if (bench.without_stalls()) {
      check_left_out(bench.checks(), finished, g, first, at, cycles, expected.groups[g].size());
    }
    visits_seen += at - first;
    any_finished = any_finished || finished.finished(g);
  }
  if (plan.reads_overlap) {
    bench.checks().that(
        2 * cycles.back() < bench.counter("nodes_read") * bench_config.latency_cycles,
        "reads wait for each other");
  }
  bench.check_counter("visits", visits_seen);
  if (plan.finished_before) bench.checks().equal(visits_seen, std::uint64_t{0}, "visits");
  check_counters(bench, plan, expected, any_finished || plan.finished_columns > 0);
  // Nodes of a group that is walked ahead are not looked up. With more than one group they may be
  // opened, and the nodes below them are hidden.
  if (plan.finished_columns == 0 || plan.job.groups.size() == 1) {
    bench.checks().that(
        (plan.finished_columns > 0) == (expected.nodes_hidden != expected.chunks_hidden),
        "a case that tells hidden nodes from hidden chunks");
    bench.check_counter("nodes_hidden", expected.nodes_hidden);
    bench.check_counter("chunks_hidden", expected.chunks_hidden);
  } else {
    bench.checks().that(bench.counter("nodes_hidden") <= expected.nodes_hidden &&
                            bench.counter("chunks_hidden") >= expected.chunks_hidden,
                        "what is behind finished sub-tiles");
  }
  // 4 rows of a byte.
  bench.check_accesses("finished sub-tiles", 32 * bench.counter("looked_up"), mask.news());
}

void random_case(Case& test) {
  std::mt19937_64& random = test.random;
  ExactVsuPlan plan = plan_of(random_scene(random, random_shape(random)),
                              1 + static_cast<std::uint32_t>(random() % 20));
  plan.hfus = 1 + static_cast<std::uint32_t>(random() % 6);
  plan.fifo_entries = 1 + static_cast<std::uint32_t>(random() % 6);
  plan.config.test_lanes = 1 + static_cast<std::uint32_t>(random() % 600);
  plan.config.queue_entries =
      kChunkNodeWidth + 1 + static_cast<std::uint32_t>(random() % (random() % 2 == 0 ? 10 : 500));
  plan.config.node_queue_entries =
      kChunkNodeWidth + 1 + static_cast<std::uint32_t>(random() % (random() % 2 == 0 ? 10 : 500));
  plan.config.upper_nodes = static_cast<std::uint32_t>(random() % 40);
  plan.config.nodes_in_flight = 1 + static_cast<std::uint32_t>(random() % 12);
  plan.config.nodes_in_test = 1 + static_cast<std::uint32_t>(random() % 12);
  plan.config.test_depth_cycles = 1 + static_cast<std::uint32_t>(random() % 250);
  plan.config.cycles_per_queue_operation = 2 + static_cast<std::uint32_t>(random() % 3);
  plan.saturate_one_in = random() % 3 == 0 ? 10 : 0;
  plan.feedback_cycles = 1 + static_cast<std::uint32_t>(random() % 40);
  run_plan(test, random_bench(random, memory_bytes(plan.job)), plan);
}

}  // namespace
}  // namespace sgs::tb

int sc_main(int argc, char* argv[]) {
  using namespace sgs;
  using namespace sgs::tb;
  CaseRunner runner("tb_exact_vsu", "Voxel sorting unit in exact order, against the walk alone");
  // A scene of 600 Gaussians but for `shape`, in chunks of so many, by a unit but for `change`.
  const auto add = [&](const std::string& name, std::uint32_t chunk, auto shape, auto change) {
    runner.add_directed(name, [=](Case& test) {
      SceneShape own;
      own.gaussians = 600;
      shape(own);
      ExactVsuPlan plan = plan_of(random_scene(test.random, own), chunk);
      BenchConfig config = still_bench(memory_bytes(plan.job));
      change(plan, config);
      run_plan(test, config, plan);
    });
  };
  const auto same = [](SceneShape&) {};
  const auto gaussians = [](std::size_t count) {
    return [=](SceneShape& shape) { shape.gaussians = count; };
  };
  const auto entries = [](std::uint32_t count) {
    return [=](ExactVsuPlan& plan, BenchConfig&) {
      plan.config.queue_entries = plan.config.node_queue_entries = count;
    };
  };
  add("several groups", 8, same, entries(512));
  add("a queue of nine entries", 1, same, entries(9));
  add("empty scene", 16, gaussians(0), entries(512));
  add("one Gaussian", 16, gaussians(1), entries(512));
  const auto pixel = [](SceneShape& shape) { shape.width_px = shape.height_px = 1; };
  add("1x1 frame", 16, pixel, entries(512));
  const auto whole = [](SceneShape& shape) { shape.group = square_of(64); };
  add("group larger than the frame", 16, whole, entries(512));
  for (const PixelSize& group : {PixelSize{64, 24}, PixelSize{64, 64}}) {
    add(
        fmt::format("left parts of groups of {} x {} are finished", group.width, group.height), 2,
        [=](SceneShape& shape) { shape.group = group; },
        [](ExactVsuPlan& plan, BenchConfig&) { plan.finished_columns = 6; });
  }
  add("groups finished before they begin", 8, same,
      [](ExactVsuPlan& plan, BenchConfig&) { plan.finished_before = true; });
  // Entries put aside for a group that ends early must not come back in the next.
  const auto crowded = [](SceneShape& shape) {
    shape.gaussians = 1000;
    shape.group = square_of(8);
  };
  add("groups that finish while entries are put aside", 1, crowded,
      [](ExactVsuPlan& plan, BenchConfig&) {
        plan.config.queue_entries = plan.config.node_queue_entries = kChunkNodeWidth + 1;
        plan.saturate_one_in = 12;
        plan.fifo_entries = 1;
      });
  add("the next group's walk begins while this one's visits wait", 4, gaussians(300),
      [](ExactVsuPlan& plan, BenchConfig&) { plan.hfus_begin_at = 50'000; });
  add("reads overlap", 2, gaussians(1000), [](ExactVsuPlan& plan, BenchConfig& config) {
    plan.config.upper_nodes = 0;
    plan.config.nodes_in_flight = 4;
    plan.reads_overlap = true;
    config.latency_cycles = 200;
  });
  runner.set_random(random_case);
  return runner.run(argc, argv);
}
