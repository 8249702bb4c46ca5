// Voxel sorting unit in exact order, alone: the chunk tree in memory, visits out to several HFUs.
// Checked against the same walk over the tree itself; cycles and bytes against that walk's counts.
#include <algorithm>
#include <limits>

#include "algorithm/order/tree_in_memory.h"
#include "algorithm/splat/lane_macs.h"
#include "algorithm/splat/reorder.h"
#include "algorithm/storage/build_memory_image.h"
#include "algorithm/voxel/chunk_tree.h"
#include "algorithm/voxel/chunk_work.h"
#include "modules/streaminggs/vsu/exact_vsu.h"
#include "testbench/units/case_runner.h"
#include "testbench/units/job_memory.h"
#include "testbench/units/random_scene.h"
#include "testbench/units/reported_groups.h"
#include "testbench/units/unit_bench.h"

namespace sgs::tb {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

struct Plan {
  ExactVsuConfig config;
  ChunkTree tree;
  MemoryImage image;
  StreamingJob job;
  std::uint32_t hfus = 4;
  std::uint32_t fifo_entries = kVisitFifoEntries;
  std::uint32_t feedback_cycles = 1;
  int saturate_one_in = 0;       // 0: never; else how often a reader reports a group as finished
  bool finished_before = false;  // all groups are reported before the first visit
};

Plan plan_of(const TestScene& scene, std::uint32_t chunk) {
  Plan plan;
  auto [tree, order] = arrange_by_chunks(scene.cloud, chunk);
  plan.tree = std::move(tree);
  const std::uint64_t aside_bytes =
      (plan.tree.chunk_count + plan.tree.nodes.size()) * kWalkEntryBytes;
  plan.job = scene.job;
  plan.image = build_memory_image(encode_raw(reordered(scene.cloud, order)), plan.tree);
  place(plan.image.layout, aside_bytes, plan.job);
  return plan;
}

struct Expected {
  std::vector<std::vector<WalkEntry>> groups;  // chunks in order
  WalkCounters walk;
  std::uint64_t cycles = 0, empty = 0, visits = 0;
};

std::uint64_t macs_of_a_test() { return folded_macs(chunk_work(longest_chunk_case())); }

Expected expect(const Plan& plan) {
  Expected out;
  TreeInMemory source{plan.tree, {}};
  ChunkWalk<TreeInMemory> walk(plan.job.view, source, plan.config.queue_entries);
  for (const PixelRect& group : plan.job.groups) {
    out.groups.emplace_back();
    walk.start(group, plan.tree.nodes.empty());
    while (true) {
      const WalkCounters before = walk.counters();
      const std::optional<WalkEntry> chunk = walk.next();
      const std::uint64_t tests = walk.counters().tests - before.tests;
      const std::uint64_t lanes = plan.config.test_lanes;
      // A queue operation, one a node, and the tests.
      out.cycles += 1 + (walk.counters().nodes - before.nodes) +
                    (tests * macs_of_a_test() + lanes - 1) / lanes;
      if (!chunk) break;
      out.groups.back().push_back(*chunk);
    }
    out.visits += out.groups.back().size();
    out.empty += out.groups.back().empty() ? 1 : 0;
  }
  out.walk = walk.counters();
  return out;
}

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

void check_counters(UnitBench& bench, const Plan& plan, const Expected& expected,
                    bool any_finished) {
  Checks& checks = bench.checks();
  const std::uint64_t aside_bytes = bench.counter("queue_entries_put_aside") * kWalkEntryBytes;
  const std::uint64_t misses = bench.counter("node_cache_misses");
  checks.equal(bench.bytes_written(), aside_bytes, "bytes put aside");
  checks.that(bench.counter("queue_entries_max") <= plan.config.queue_entries,
              "the queue holds more than it can");
  const std::uint64_t table_bytes = misses * sizeof(ChunkNode);
  checks.that(bench.bytes_read() >= table_bytes, "bytes read of the tree");
  checks.that(bench.bytes_read() <= table_bytes + aside_bytes, "bytes read of what was put aside");
  bench.check_operations("vsu", "fp32_lane", bench.counter("tests") * macs_of_a_test());
  // Four accesses of 32 B a node, all tags of a set at once.
  const std::uint64_t nodes = bench.counter("nodes");
  bench.check_accesses("node cache", 4 * nodes, 4 * misses);
  bench.check_accesses("node cache tags", nodes, nodes);
  if (any_finished) return;
  bench.check_counter("visits", expected.visits);
  bench.check_counter("nodes", expected.walk.nodes);
  bench.check_counter("tests", expected.walk.tests);
  bench.check_counter("queue_entries_put_aside", expected.walk.overflowed);
  bench.check_counter("queue_entries_max", expected.walk.queue_max);
  bench.check_counter("groups_empty", expected.empty);
  bench.check_counter("groups_saturated", 0);
  checks.equal(bench.busy_cycles("vsu"), expected.cycles, "busy cycles");
  // A cache that holds the whole tree reads each node once.
  const std::uint64_t tree_bytes = plan.tree.nodes.size() * sizeof(ChunkNode);
  if (4 * tree_bytes <= plan.config.node_cache_bytes) {
    checks.that(misses <= plan.tree.nodes.size(), "nodes read again");
  }
}

void run_plan(Case& test, const BenchConfig& bench_config, const Plan& plan) {
  const Expected expected = expect(plan);
  UnitBench bench(test, bench_config);
  bench.load(0, plan.image.bytes);
  ReportedGroups finished(bench.clock(), plan.job.groups.size(), plan.feedback_cycles);
  for (std::uint32_t g = 0; plan.finished_before && g < plan.job.groups.size(); ++g) {
    finished.finish(g);
  }
  const auto visits = bench.add_fifos<VisitShare>("to_hfu", plan.hfus, plan.fifo_entries, 1);
  ExactVsu unit("vsu", plan.config, bench.context(plan.job), plan.job.spill);
  for (TimedFifo<VisitShare>* fifo : visits) unit.visits(*fifo);
  unit.finished(finished.channel);
  bench.add_unit(unit);
  std::vector<VisitShare> received;
  std::vector<std::uint64_t> cycles;  // in which they came
  bench.add_thread("hfus", [&](Activity& activity) {
    for (std::size_t ends = 0; ends < plan.job.groups.size();) {
      received.push_back(visits[received.size() % plan.hfus]->pop(activity));
      cycles.push_back(bench.clock().now_cycles());
      ends += received.back().mark == Mark::kEndOfGroup ? 1 : 0;
      if (plan.saturate_one_in > 0 &&
          test.random() % static_cast<unsigned>(plan.saturate_one_in) == 0) {
        finished.finish(received.back().group);
      }
    }
    // What the last group put aside may still be on its way.
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
      const auto begin = cycles.begin() + static_cast<std::ptrdiff_t>(first);
      check_feedback(bench.checks(), finished, g,
                     {begin, begin + static_cast<std::ptrdiff_t>(at - first)},
                     expected.groups[g].size());
    }
    visits_seen += at - first;
    any_finished = any_finished || finished.finished(g);
  }
  bench.check_counter("visits", visits_seen);
  if (plan.finished_before) bench.checks().equal(visits_seen, std::uint64_t{0}, "visits");
  check_counters(bench, plan, expected, any_finished);
}

BenchConfig still_bench(const Plan& plan) {
  BenchConfig config;
  config.memory_bytes = memory_bytes(plan.job);
  return config;
}

void directed(Case& test, const SceneShape& shape, std::uint32_t chunk,
              std::uint32_t queue_entries) {
  Plan plan = plan_of(random_scene(test.random, shape), chunk);
  plan.config.queue_entries = queue_entries;
  run_plan(test, still_bench(plan), plan);
}

void random_case(Case& test) {
  std::mt19937_64& random = test.random;
  Plan plan = plan_of(random_scene(random, random_shape(random)),
                      1 + static_cast<std::uint32_t>(random() % 20));
  plan.hfus = 1 + static_cast<std::uint32_t>(random() % 6);
  plan.fifo_entries = 1 + static_cast<std::uint32_t>(random() % 6);
  plan.config.test_lanes = 1 + static_cast<std::uint32_t>(random() % 600);
  plan.config.queue_entries =
      kChunkNodeWidth + 1 + static_cast<std::uint32_t>(random() % (random() % 2 == 0 ? 10 : 500));
  plan.config.node_cache_bytes = 64U << (random() % 14);
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
  SceneShape shape;
  shape.gaussians = 600;
  runner.add_directed("several groups", [=](Case& test) { directed(test, shape, 8, 512); });
  runner.add_directed("a queue of nine entries", [=](Case& test) { directed(test, shape, 1, 9); });
  SceneShape empty = shape;
  empty.gaussians = 0;
  runner.add_directed("empty scene", [=](Case& test) { directed(test, empty, 16, 512); });
  SceneShape one = shape;
  one.gaussians = 1;
  runner.add_directed("one Gaussian", [=](Case& test) { directed(test, one, 16, 512); });
  SceneShape pixel = shape;
  pixel.width_px = pixel.height_px = 1;
  runner.add_directed("1x1 frame", [=](Case& test) { directed(test, pixel, 16, 512); });
  SceneShape whole = shape;
  whole.group_px = 64;
  runner.add_directed("group larger than the frame",
                      [=](Case& test) { directed(test, whole, 16, 512); });
  runner.add_directed("groups finished before they begin", [=](Case& test) {
    Plan plan = plan_of(random_scene(test.random, shape), 8);
    plan.finished_before = true;
    run_plan(test, still_bench(plan), plan);
  });
  // Entries put aside for a group that ends early must not come back in the next.
  runner.add_directed("groups that finish while entries are put aside", [=](Case& test) {
    SceneShape crowded = shape;
    crowded.gaussians = 1000;
    crowded.group_px = 8;
    Plan plan = plan_of(random_scene(test.random, crowded), 1);
    plan.config.queue_entries = kChunkNodeWidth + 1;
    plan.saturate_one_in = 12;
    plan.fifo_entries = 1;
    run_plan(test, still_bench(plan), plan);
  });
  runner.set_random(random_case);
  return runner.run(argc, argv);
}
