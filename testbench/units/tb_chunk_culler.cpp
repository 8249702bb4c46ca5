// The culler alone: the tree of a scene in memory and passes in, slices of Gaussians out. Checked
// against all chunks below nodes that touch the frame; cycles and bytes against the counts of those
// nodes.
#include <algorithm>

#include "modules/datapath/work_rates.h"
#include "modules/gscore/culling/chunk_culler.h"
#include "modules/gscore/gscore_datapaths.h"
#include "testbench/units/chunk_culler_plan.h"

namespace sgs::tb {
namespace {

struct Expected {
  std::vector<bool> visible;  // [slot]
  std::uint64_t nodes = 0, tests = 0, chunks = 0, gaussians = 0;
};

// By the test that a walk by depth makes.
void expect_node(const CullerPlan& plan, std::uint32_t at, Expected& out) {
  const View<float>& view = plan.frame.view;
  const GroupFrustum frame(view, {0, 0, view.width, view.height});
  const ChunkNode& node = plan.tree.nodes[at];
  std::uint32_t slot = node.first_slot, inner = node.first_node;
  ++out.nodes;
  out.tests += node.children;
  for (int c = 0; c < node.children; ++c) {
    const bool touches = frame.test(child_bound(node, c)).touches;
    const std::uint32_t count = node.count[c];
    if (touches && count == 0) expect_node(plan, inner, out);
    if (touches && count > 0) {
      ++out.chunks;
      out.gaussians += count;
      std::fill_n(out.visible.begin() + slot, count, true);
    }
    slot += count;
    inner += count == 0 ? 1 : 0;
  }
}

// Visible Gaussians in storage order, cut where there is a gap and at multiples of a slice.
std::vector<VisibleSlice> slices_of(const Expected& expected, std::uint32_t size) {
  std::vector<VisibleSlice> out;
  for (std::uint32_t slot = 0; slot < expected.visible.size(); ++slot) {
    if (!expected.visible[slot]) continue;
    const bool joins =
        !out.empty() && out.back().first + out.back().count == slot && slot % size != 0;
    if (!joins) out.push_back({slot, 0});
    ++out.back().count;
  }
  return out;
}

void run_plan(Case& test, const BenchConfig& bench_config, CullerPlan plan) {
  UnitBench bench(test, bench_config);
  Checks& checks = bench.checks();
  const GscoreConfig& config = plan.config;
  const GscoreJob job = gscore_frame(plan.config, bench, plan.frame);
  bench.load(0, plan.image.bytes);
  auto& passes = bench.add_fifo<Pass>("passes", 1, 1);
  auto slices = bench.add_fifos<VisibleSlice>("slices", config.ccus, 2, 1);
  gscore::Phases phases;
  ChunkCuller unit("culler", {bench.clock(), job, config, phases});
  unit.passes(passes);
  for (auto* fifo : slices) unit.slices(*fifo);
  bench.add_unit(unit);
  phases.projecting.begin();

  Expected expected;
  expected.visible.resize(job.layout.gaussian_count());
  if (!plan.tree.nodes.empty()) expect_node(plan, 0, expected);
  std::vector<VisibleSlice> one_pass = slices_of(expected, config.ccu.slice_gaussians);
  if (one_pass.empty() && !expected.visible.empty()) one_pass.emplace_back();
  if (!one_pass.empty()) one_pass.back().end_of_pass = true;
  bench.add_thread("lister", [&](Activity& activity) {
    for (std::uint32_t p = 0; p < plan.passes; ++p) {
      passes.push({0, job.tile_count, false}, activity);
    }
    Pass over;
    over.over = true;
    passes.push(over, activity);
  });
  bench.add_thread("ccus", [&](Activity& activity) {
    for (std::uint32_t p = 0; p < plan.passes; ++p) {
      for (std::size_t s = 0; s < one_pass.size(); ++s) {
        const VisibleSlice got = slices[s % config.ccus]->pop(activity);
        const VisibleSlice& wanted = one_pass[s];
        checks.that(!got.over && got.first == wanted.first && got.count == wanted.count &&
                        got.end_of_pass == wanted.end_of_pass,
                    fmt::format("slice {}: got {} from {}, expected {} from {}", s, got.count,
                                got.first, wanted.count, wanted.first));
      }
    }
    for (auto* fifo : slices) checks.that(fifo->pop(activity).over, "the frame is over");
  });
  bench.run();

  const std::uint64_t nodes = expected.nodes * plan.passes, chunks = expected.chunks * plan.passes;
  const std::uint64_t handed_out = one_pass.size() * plan.passes;
  bench.check_counter("nodes", nodes);
  bench.check_counter("tests", expected.tests * plan.passes);
  bench.check_counter("chunks", chunks);
  bench.check_counter("gaussians", expected.gaussians * plan.passes);
  bench.check_counter("slices", handed_out);
  checks.equal(bench.bytes_read(), nodes * sizeof(ChunkNode), "bytes read");
  // A node is asked for, taken to the test, taken from it and opened; a pass ends.
  checks.equal(bench.busy_cycles("culling"), 4 * nodes + chunks + plan.passes,
               "cycles of the walk");
  checks.equal(bench.busy_cycles("slices"), chunks + plan.passes + handed_out,
               "cycles of handing out");
  const Datapath lanes = chunk_test_pipeline(config);
  checks.that(
      bench.busy_cycles("chunk_tests") >= expected.tests * plan.passes * lanes.interval_cycles(),
      "cycles of the tests");
  bench.check_operations("culler", "fp32_lane",
                         expected.tests * plan.passes * std::uint64_t{lanes.used_macs});
  // Four accesses of 32 B a node.
  bench.check_accesses("nodes in flight", 4 * nodes, 4 * nodes);
  bench.check_accesses("nodes in test", 4 * nodes, 4 * nodes);
  bench.check_accesses("tested nodes", nodes, nodes);
}

void random_case(Case& test) {
  std::mt19937_64& random = test.random;
  SceneShape shape = random_shape(random);
  shape.extent = random() % 2 == 0 ? 4.0F : 30.0F;
  CullerPlan plan = culler_plan(random, shape, 1 + static_cast<std::uint32_t>(random() % 20));
  plan.config.ccus = 1 + static_cast<std::uint32_t>(random() % 5);
  plan.config.ccu.slice_gaussians = 1 + static_cast<std::uint32_t>(random() % 16);
  CullingConfig& c = plan.config.culling;
  c.nodes_in_flight = 1 + static_cast<std::uint32_t>(random() % 8);
  c.nodes_in_test = 1 + static_cast<std::uint32_t>(random() % 4);
  c.nodes_tested = 1 + static_cast<std::uint32_t>(random() % 12);
  c.test_lanes = 1 + static_cast<std::uint32_t>(random() % 300);
  plan.passes = 1 + static_cast<std::uint32_t>(random() % 3);
  run_plan(test, random_bench(random, kGscoreMemoryBytes), plan);
}

}  // namespace
}  // namespace sgs::tb

int sc_main(int argc, char* argv[]) {
  using namespace sgs;
  using namespace sgs::tb;
  CaseRunner runner("tb_chunk_culler", "Culler of chunks alone");
  const auto directed = [&](const char* name, std::size_t gaussians, float extent,
                            std::uint32_t chunk, std::uint32_t passes, float forward = 0) {
    runner.add_directed(name, [=](Case& test) {
      SceneShape shape;
      shape.gaussians = gaussians;
      shape.extent = extent;
      CullerPlan plan = culler_plan(test.random, shape, chunk);
      plan.passes = passes;
      plan.frame.view.position += forward * plan.frame.view.cam_from_world[2];
      run_plan(test, still_bench(kGscoreMemoryBytes), plan);
    });
  };
  directed("empty scene", 0, 4, 8, 2);
  directed("one Gaussian", 1, 4, 8, 1);
  directed("chunks of one", 300, 4, 1, 1);
  directed("most of it culled", 2000, 60, 8, 1);
  directed("one chunk for all", 200, 4, 1000, 1);
  directed("several passes", 600, 10, 8, 3);
  directed("all of it behind the camera", 600, 4, 8, 2, 1000);
  runner.set_random(random_case);
  return runner.run(argc, argv);
}
