// The culler against its clocked reference: every slice that it hands out.
#include <catch2/catch.hpp>

#include "modules/gscore/culling/chunk_culler.h"
#include "modules/gscore/gscore_datapaths.h"
#include "testbench/units/chunk_culler_plan.h"
#include "tests/modules/clocked/comparison.h"
#include "tests/modules/gscore/clocked/clocked_culler.h"

namespace sgs::test {
namespace {

using namespace gscore;

constexpr std::uint32_t kCulledPasses = 2;

struct CullerWorkload {
  const char* name;
  std::size_t gaussians = 2000;
  float extent = 10;  // of the scene; the wider, the more is culled
  CullingConfig culling;
  PortHardware port = {};
  std::uint32_t out_one_in = 1, out_longest = 1, ccus = 4;
};

tb::CullerPlan plan_of(const CullerWorkload& load, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  tb::SceneShape shape;
  shape.gaussians = load.gaussians;
  shape.extent = load.extent;
  tb::CullerPlan plan = tb::culler_plan(random, shape, 8);
  plan.config.culling = load.culling;
  plan.config.culling.by = CullingBy::kChunkBoxes;
  plan.config.ccus = load.ccus;
  return plan;
}

std::uint64_t what_of(const VisibleSlice& slice) {
  return ClockedCuller::what_of(slice.first, slice.count, slice.end_of_pass);
}

// Slices come from one CCU's FIFO after the other, in every pass from the first on.
template <class Take>
Takings taken_in_turn(std::uint32_t ccus, const Take& take) {
  Takings taken;
  for (std::uint32_t pass = 0; pass < kCulledPasses; ++pass) {
    for (std::uint32_t turn = 0;; ++turn) {
      taken.push_back(take(turn % ccus, taken.size()));
      if ((taken.back().what & 1U) != 0) break;
    }
  }
  return taken;
}

void run_culler(tb::Case& test, Takings& taken, const CullerWorkload& load, std::uint64_t seed) {
  tb::CullerPlan plan = plan_of(load, seed);
  tb::UnitBench bench(test, bench_of(load.port, tb::kGscoreMemoryBytes));
  const GscoreJob job = tb::gscore_frame(plan.config, bench, plan.frame);
  bench.load(0, plan.image.bytes);
  auto& passes = bench.add_fifo<Pass>("passes", 1, 1);
  auto slices = bench.add_fifos<VisibleSlice>("slices", load.ccus, 2, 1);
  gscore::Phases phases;
  ChunkCuller unit("culler", {bench.clock(), job, plan.config, phases});
  phases.projecting.begin();
  unit.passes(passes);
  for (auto* fifo : slices) unit.slices(*fifo);
  bench.add_unit(unit);
  bench.add_thread("lister", [&](Activity& activity) {
    for (std::uint32_t p = 0; p < kCulledPasses; ++p)
      passes.push({0, job.tile_count, false}, activity);
    Pass over;
    over.over = true;
    passes.push(over, activity);
  });
  const Pace pace(seed + 1000, load.out_one_in, load.out_longest);
  bench.add_thread("ccus", [&](Activity& activity) {
    taken = taken_in_turn(load.ccus, [&](std::uint32_t ccu, std::size_t number) {
      bench.clock().wait_cycles(pace.gap(number));
      const std::uint64_t what = what_of(slices[ccu]->pop(activity));
      return Taken{bench.clock().now_cycles(), what};
    });
    for (auto* fifo : slices) bench.checks().that(fifo->pop(activity).over, "the end");
  });
  bench.run();
}

Takings clocked_culler(const CullerWorkload& load, std::uint64_t seed) {
  const tb::CullerPlan plan = plan_of(load, seed);
  const Datapath lanes = chunk_test_pipeline(plan.config);
  CullerHardware hw;
  hw.nodes_in_flight = load.culling.nodes_in_flight;
  hw.nodes_in_test = load.culling.nodes_in_test;
  hw.nodes_tested = load.culling.nodes_tested;
  hw.slice_gaussians = plan.config.ccu.slice_gaussians;
  hw.tests = {static_cast<std::uint32_t>(lanes.interval_cycles()), lanes.depth_cycles};
  hw.port = load.port;
  ClockedCuller unit(hw, plan.frame.view, plan.tree.nodes, plan.image.layout.chunk_table().nodes);
  ClockedFifo<std::uint64_t> passes(1);
  std::vector<ClockedFifo<std::uint64_t>> slices(load.ccus, ClockedFifo<std::uint64_t>(2));
  const Pace pace(seed + 1000, load.out_one_in, load.out_longest);
  std::uint64_t now = 0;
  std::uint32_t begun = 0;
  const auto step = [&] {
    unit.step(passes, slices);
    if (begun < kCulledPasses && passes.has_room()) passes.put(begun++);
    passes.step();
    for (ClockedFifo<std::uint64_t>& fifo : slices) fifo.step();
    ++now;
  };
  return taken_in_turn(load.ccus, [&](std::uint32_t ccu, std::size_t number) {
    for (std::uint32_t gap = pace.gap(number); gap > 0; --gap) step();
    while (!slices[ccu].can_take()) step();
    const std::uint64_t what = slices[ccu].take();
    return Taken{now, what};
  });
}

TEST_CASE("clocked reference: culler") {
  Comparison table("culler");
  const CullingConfig preset;
  const PortHardware port{port_of_preset("gscore_lossless_boxes", GscoreConfig{}.memory_port)};
  PortHardware slow = port, one = port;
  slow.read_latency = 400;
  one.config.max_outstanding = 1;
  const CullingConfig tiny = changed(preset, [](CullingConfig& c) {
    c.nodes_in_flight = c.nodes_in_test = c.nodes_tested = 1;
    c.test_lanes = 5;
  });
  const CullingConfig wide = changed(preset, [](CullingConfig& c) {
    c.nodes_in_flight = c.nodes_in_test = 4;
    c.nodes_tested = 12;
    c.test_lanes = 400;
  });
  for (const CullerWorkload& load : {
           CullerWorkload{"light: 40 Gaussians", 40, 4, preset, port},
           CullerWorkload{"heavy: 4000, few culled", 4000, 1, preset, port},
           CullerWorkload{"many culled", 4000, 40, preset, port},
           CullerWorkload{"slow memory", 2000, 10, preset, slow},
           CullerWorkload{"CCUs stalled", 2000, 10, preset, port, 3, 300},
           CullerWorkload{"tiny buffers", 1000, 10, tiny, one, 4, 20, 1},
           CullerWorkload{"wide lanes", 4000, 10, wide, port},
           CullerWorkload{"wide lanes, CCUs stalled", 2000, 4, wide, port, 2, 60, 3},
       }) {
    table.workload(load, run_culler, clocked_culler);
  }
}

}  // namespace
}  // namespace sgs::test
