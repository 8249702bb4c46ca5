// VSU of exact order against its clocked reference.
#include <catch2/catch.hpp>

#include "modules/streaminggs/exact_config.h"
#include "testbench/units/exact_vsu_plan.h"
#include "testbench/units/job_memory.h"
#include "tests/modules/clocked/comparison.h"
#include "tests/modules/streaminggs/clocked/clocked_walk.h"
#include "tests/modules/streaminggs/clocked/group_numbers_hardware.h"

namespace sgs::test {
namespace {

struct WalkWorkload {
  const char* name;
  std::size_t gaussians = 1500;
  std::uint32_t out_one_in = 1, out_longest = 1;
  WalkHardware hardware;
  std::uint32_t entries = kVisitFifoEntries, hfus = 4;
  Finishing finishing = {};
  std::uint64_t apart = 0;  // cycles, behind news that the unit sees late
};

tb::ExactVsuPlan plan_of(const WalkWorkload& load, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  tb::SceneShape shape;
  shape.gaussians = load.gaussians;
  shape.group = preset_of<ExactConfig>("exact").group;
  shape.width_px = 4 * shape.group.width;
  shape.height_px = shape.group.height;
  tb::ExactVsuPlan plan = tb::plan_of(tb::random_scene(random, shape), 8);
  const WalkHardware& hw = load.hardware;
  plan.config.upper_nodes = hw.upper_nodes;
  plan.config.nodes_in_flight = hw.nodes_in_flight;
  plan.config.nodes_in_test = hw.nodes_in_test;
  plan.config.test_lanes = static_cast<std::uint32_t>(
      (tb::macs_of_a_test() + hw.tests.test_cycles - 1) / hw.tests.test_cycles);
  plan.config.test_depth_cycles = hw.tests.depth_cycles;
  plan.config.cycles_per_queue_operation = hw.operation_cycles;
  plan.config.queue_entries = hw.queue_entries;
  plan.config.node_queue_entries = hw.node_queue_entries;
  return plan;
}

std::uint64_t what_of_visit(const VisitShare& visit) {
  return visit.mark == Mark::kEndOfGroup ? ClockedWalk::kEndOfGroup : visit.first;
}

void run_walk(tb::Case& test, Takings& taken, const WalkWorkload& load, std::uint64_t seed) {
  const tb::ExactVsuPlan plan = plan_of(load, seed);
  tb::UnitBench bench(test, bench_of(load.hardware.port, tb::memory_bytes(plan.job)));
  bench.load(0, plan.image.bytes);
  FinishedGroups finished("finished", bench.clock(), plan.job.groups.size(), 1);
  add_finishing(bench, load.finishing, plan.job.groups.size(), finished);
  FinishedSubtiles mask("mask", bench.clock(), plan.job.groups, 1);
  add_finishing_subtiles(bench, load.finishing, plan.job.groups, mask);
  const auto visits = bench.add_fifos<VisitShare>("to_hfu", load.hfus, load.entries, 1);
  UnitContext context = bench.context(plan.job);
  context.built_for.group = preset_of<ExactConfig>("exact").group;
  ExactVsu unit("vsu", plan.config, context, plan.job.spill);
  for (TimedFifo<VisitShare>* fifo : visits) unit.visits(*fifo);
  unit.finished(finished);
  unit.masks(mask);
  bench.add_unit(unit);
  const Pace pace(seed + 1000, load.out_one_in, load.out_longest);
  bench.add_thread("hfus", [&](Activity& activity) {
    for (std::size_t ends = 0; ends < plan.job.groups.size();) {
      bench.clock().wait_cycles(pace.gap(taken.size()));
      const std::uint64_t what = what_of_visit(visits[taken.size() % load.hfus]->pop(activity));
      taken.push_back({bench.clock().now_cycles(), what});
      ends += what == ClockedWalk::kEndOfGroup ? 1 : 0;
    }
  });
  bench.run();
}

Takings clocked_walk(const WalkWorkload& load, std::uint64_t seed) {
  const tb::ExactVsuPlan plan = plan_of(load, seed);
  ClockedWalk unit(load.hardware, plan.job.view, plan.tree.nodes,
                   plan.job.layout.chunk_table().nodes, plan.job.groups, load.finishing);
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
  WalkHardware exact;
  exact.port.config = preset_of<ExactConfig>("exact").port;
  exact.numbers = hardware_of(GroupUse::kWalk);
  WalkHardware far = exact;
  far.port.read_latency = 300;
  WalkHardware tiny = exact;
  tiny.nodes_in_flight = 1;
  tiny.nodes_in_test = 1;
  tiny.upper_nodes = 1;
  WalkHardware narrow = exact;
  narrow.tests.test_cycles = 29;
  narrow.nodes_in_test = 3;
  WalkHardware bare = exact;
  bare.upper_nodes = 0;
  WalkHardware fast = exact;
  fast.operation_cycles = 2;
  fast.tests.test_cycles = 1;
  for (const WalkWorkload& load : {
           WalkWorkload{"light: 100 Gaussians", 100, 1, 1, exact},
           WalkWorkload{"heavy: 3000 Gaussians", 3000, 1, 1, exact},
           WalkWorkload{"output stalled", 1500, 4, 300, exact},
           WalkWorkload{"memory of 300 cycles", 1500, 1, 1, far},
           WalkWorkload{"tiny buffers", 1500, 1, 1, tiny, 1, 1},
           WalkWorkload{"no node on chip", 1500, 1, 1, bare},
           WalkWorkload{"a child every 29 cycles", 1500, 1, 1, narrow},
           WalkWorkload{"a child a cycle, operations of 2", 1500, 1, 1, fast},
           WalkWorkload{"groups that finish", 3000, 1, 1, exact, 4, 4, {3000}, 30},
       }) {
    table.workload(load, run_walk, clocked_walk, load.apart);
  }
}

}  // namespace
}  // namespace sgs::test
