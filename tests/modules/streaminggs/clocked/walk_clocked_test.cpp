// VSU of exact order against its clocked reference.
#include <catch2/catch.hpp>

#include "testbench/units/exact_vsu_plan.h"
#include "testbench/units/job_memory.h"
#include "testbench/units/reported_groups.h"
#include "tests/modules/clocked/comparison.h"
#include "tests/modules/streaminggs/clocked/clocked_walk.h"

namespace sgs::test {
namespace {

struct WalkWorkload {
  const char* name;
  std::size_t gaussians = 1500;
  std::uint32_t out_one_in = 1, out_longest = 1;
  WalkHardware hardware;
  std::uint32_t entries = kVisitFifoEntries, hfus = 4;
};

tb::ExactVsuPlan plan_of(const WalkWorkload& load, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  tb::SceneShape shape;
  shape.gaussians = load.gaussians;
  tb::ExactVsuPlan plan = tb::plan_of(tb::random_scene(random, shape), 16);
  const WalkHardware& hw = load.hardware;
  plan.config.upper_nodes = hw.upper_nodes;
  plan.config.nodes_in_flight = hw.nodes_in_flight;
  plan.config.nodes_in_test = hw.nodes_in_test;
  plan.config.test_lanes =
      static_cast<std::uint32_t>((tb::macs_of_a_test() + hw.test_cycles - 1) / hw.test_cycles);
  plan.config.test_depth_cycles = hw.depth_cycles;
  plan.config.cycles_per_queue_operation = hw.operation_cycles;
  plan.config.queue_entries = hw.queue_entries;
  plan.config.node_queue_entries = hw.node_queue_entries;
  return plan;
}

std::uint64_t what_of(const VisitShare& visit) {
  return visit.mark == Mark::kEndOfGroup ? ClockedWalk::kEndOfGroup : visit.first;
}

void run(tb::Case& test, Takings& taken, const WalkWorkload& load, std::uint64_t seed) {
  const tb::ExactVsuPlan plan = plan_of(load, seed);
  tb::BenchConfig config;
  config.latency_cycles = load.hardware.memory_latency;
  config.memory_bytes = tb::memory_bytes(plan.job);
  tb::UnitBench bench(test, config);
  bench.load(0, plan.image.bytes);
  tb::ReportedGroups finished(bench.clock(), plan.job.groups.size(), 1);
  FinishedSubtiles mask("mask", bench.clock(), plan.job.groups, 1);
  const auto visits = bench.add_fifos<VisitShare>("to_hfu", load.hfus, load.entries, 1);
  UnitContext context = bench.context(plan.job);
  context.built_for.group = square_of(16);
  ExactVsu unit("vsu", plan.config, context, plan.job.spill);
  for (TimedFifo<VisitShare>* fifo : visits) unit.visits(*fifo);
  unit.finished(finished.channel);
  unit.mask(mask);
  bench.add_unit(unit);
  const Pace pace(seed + 1000, load.out_one_in, load.out_longest);
  bench.add_thread("hfus", [&](Activity& activity) {
    for (std::size_t ends = 0; ends < plan.job.groups.size();) {
      bench.clock().wait_cycles(pace.gap(taken.size()));
      const std::uint64_t what = what_of(visits[taken.size() % load.hfus]->pop(activity));
      taken.push_back({bench.clock().now_cycles(), what});
      ends += what == ClockedWalk::kEndOfGroup ? 1 : 0;
    }
  });
  bench.run();
}

Takings clocked(const WalkWorkload& load, std::uint64_t seed) {
  const tb::ExactVsuPlan plan = plan_of(load, seed);
  WalkHardware hardware = load.hardware;
  const RecordArray& table = plan.job.layout.chunk_table().nodes;
  const std::uint64_t loaded = std::min<std::uint64_t>(hardware.upper_nodes, table.count);
  const std::uint64_t longest = MemoryPortConfig{}.max_transaction_bytes;
  hardware.upper_transactions = static_cast<std::uint32_t>(
      (table.base + loaded * sizeof(ChunkNode) - 1) / longest - table.base / longest + 1);
  ClockedWalk unit(hardware, plan.job.view, plan.tree.nodes, plan.job.groups);
  std::vector<ClockedFifo<std::uint64_t>> visits(load.hfus,
                                                 ClockedFifo<std::uint64_t>(load.entries));
  ClockedSink<std::uint64_t> sink({seed + 1000, load.out_one_in, load.out_longest});
  const auto is_end = [](const Taken& t) { return t.what == ClockedWalk::kEndOfGroup; };
  for (std::uint64_t now = 0;; ++now) {
    sink.step(visits[sink.taken().size() % load.hfus], now);
    const auto ends = std::count_if(sink.taken().begin(), sink.taken().end(), is_end);
    if (static_cast<std::size_t>(ends) == plan.job.groups.size()) break;
    unit.step(visits);
    for (ClockedFifo<std::uint64_t>& fifo : visits) fifo.step();
  }
  REQUIRE(unit.put_aside() == 0);
  return sink.taken();
}

TEST_CASE("clocked reference: VSU of exact order") {
  Comparison table("VSU, exact order");
  const WalkHardware exact;
  WalkHardware far = exact;
  far.memory_latency = 300;
  WalkHardware tiny = exact;
  tiny.nodes_in_flight = 1;
  tiny.nodes_in_test = 1;
  tiny.upper_nodes = 1;
  WalkHardware narrow = exact;
  narrow.test_cycles = 30;
  narrow.nodes_in_test = 3;
  WalkHardware fast = exact;
  fast.operation_cycles = 2;
  fast.test_cycles = 1;
  for (const WalkWorkload& load : {
           WalkWorkload{"light: 100 Gaussians", 100, 1, 1, exact},
           WalkWorkload{"heavy: 3000 Gaussians", 3000, 1, 1, exact},
           WalkWorkload{"output stalled", 1500, 4, 300, exact},
           WalkWorkload{"memory of 300 cycles", 1500, 1, 1, far},
           WalkWorkload{"tiny buffers", 1500, 1, 1, tiny, 1, 1},
           WalkWorkload{"a child every 30 cycles", 1500, 1, 1, narrow},
           WalkWorkload{"a child a cycle, operations of 2", 1500, 1, 1, fast},
       }) {
    table.workload(load, run, clocked);
  }
}

}  // namespace
}  // namespace sgs::test
