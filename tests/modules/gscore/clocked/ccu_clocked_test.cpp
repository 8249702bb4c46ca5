// A culling and conversion unit against its clocked reference: every Gaussian that comes out, and
// every end of a slice.
#include <catch2/catch.hpp>
#include <cstring>

#include "algorithm/splat/make_splat.h"
#include "modules/gscore/ccu/ccu.h"
#include "modules/gscore/gscore_datapaths.h"
#include "testbench/units/gscore_bench.h"
#include "testbench/units/random_scene.h"
#include "tests/modules/clocked/comparison.h"
#include "tests/modules/gscore/clocked/clocked_ccu.h"

namespace sgs::test {
namespace {

using namespace gscore;

constexpr std::uint32_t kPasses = 2;

struct CcuWorkload {
  const char* name;
  std::size_t gaussians = 600;
  float extent = 4;  // of the scene; the wider, the more is culled
  CcuConfig ccu;
  PortHardware port = {};
  std::uint32_t out_one_in = 1, out_longest = 1;
  int sh_degree = 1;
};

GscoreConfig config_of(const CcuWorkload& load) {
  GscoreConfig config;
  config.ccus = 1;
  config.lists.pool_bytes = 1 << 20;
  config.ccu = load.ccu;
  return config;
}

// The schedules' intervals and depths; a FIFO behind a pipeline has room for what is in it.
CcuHardware hardware_of(const CcuWorkload& load, const GscoreConfig& config,
                        std::uint32_t second_half_bytes) {
  const Datapath cull = cull_pipeline(config);
  const Datapath convert = convert_pipeline(config, load.sh_degree);
  const auto entries = [](std::uint32_t waiting, const Datapath& path) {
    const std::uint64_t turns =
        (path.depth_cycles + path.interval_cycles() - 1) / path.interval_cycles();
    return waiting + static_cast<std::uint32_t>(turns);
  };
  CcuHardware hw;
  hw.slice_gaussians = load.ccu.slice_gaussians;
  hw.input_slots = load.ccu.input_slots;
  hw.second_half_slots = load.ccu.second_half_slots;
  hw.cull_interval = static_cast<std::uint32_t>(cull.interval_cycles());
  hw.cull_depth = cull.depth_cycles;
  hw.cull_entries = entries(load.ccu.candidates, cull);
  hw.convert_interval = static_cast<std::uint32_t>(convert.interval_cycles());
  hw.convert_depth = convert.depth_cycles;
  hw.convert_entries = entries(load.ccu.output_entries, convert);
  hw.read_cycles = (second_half_bytes + kPortBytes - 1) / kPortBytes;
  hw.port = load.port;
  return hw;
}

tb::TestScene scene_of(const CcuWorkload& load, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  tb::SceneShape shape;
  shape.gaussians = load.gaussians;
  shape.sh_degree = load.sh_degree;
  shape.order = StorageOrder::kFile;
  shape.extent = load.extent;
  return tb::random_scene(random, shape);
}

std::uint64_t what_of(bool there, const Splat& splat) {
  if (!there) return 0;
  std::uint64_t bits[2] = {0, 0};
  std::memcpy(&bits[0], &splat.x, sizeof splat.x);
  std::memcpy(&bits[1], &splat.y, sizeof splat.y);
  return bits[0] << 32U | bits[1];
}

std::vector<CcuItem> items_of(const tb::TestScene& scene, const GscoreConfig& config) {
  const View<float>& view = scene.job.view;
  const FrameSides<float> sides = frame_sides(view);
  const SceneLayout& layout = scene.image.layout;
  std::vector<CcuItem> items(scene.cloud.size());
  for (std::uint32_t i = 0; i < items.size(); ++i) {
    const auto& g = scene.cloud.gaussians[i];
    Splat splat{};
    TileBoxes boxes{};
    CcuItem& item = items[i];
    item.slot = i;
    item.last = (i + 1) % config.ccu.slice_gaussians == 0 || i + 1 == items.size();
    const SplitFirstHalf first =
        read_first_half(layout.split, scene.image.at(layout.first_halves.address(i)));
    item.passes = may_touch_frame(view, sides, first.mean, first.extents.scale_max);
    item.goes_on = item.passes && make_tile_geometry(view, g, config.tiles.rules(), splat, boxes);
    item.what = what_of(item.goes_on, splat);
  }
  return items;
}

std::size_t handed_on(const std::vector<CcuItem>& items) {
  const auto comes = [](const CcuItem& item) { return item.goes_on || item.last; };
  return static_cast<std::size_t>(std::count_if(items.begin(), items.end(), comes));
}

void run_ccu(tb::Case& test, Takings& taken, const CcuWorkload& load, std::uint64_t seed) {
  tb::UnitBench bench(test, bench_of(load.port, tb::kGscoreMemoryBytes));
  const tb::TestScene scene = scene_of(load, seed);
  FrameJob frame = scene.job;
  frame.layout = scene.image.layout;
  GscoreConfig config = config_of(load);
  const GscoreJob job = tb::gscore_frame(config, bench, frame);
  bench.load(0, scene.image.bytes);
  const CcuHardware hw = hardware_of(load, config, job.layout.second_halves.record_bytes);
  auto& passes = bench.add_fifo<Pass>("passes", 1, 1);
  auto& converted = bench.add_fifo<Converted>("converted", hw.convert_entries, hw.convert_depth);
  gscore::Phases phases;
  Ccu unit("ccu", 0, {bench.clock(), job, config, phases});
  phases.projecting.begin();
  unit.passes(passes);
  unit.converted(converted);
  bench.add_unit(unit);
  bench.add_thread("lister", [&](Activity& activity) {
    for (std::uint32_t p = 0; p < kPasses; ++p) passes.push({0, job.tile_count, false}, activity);
    Pass over;
    over.over = true;
    passes.push(over, activity);
  });
  add_sink(bench, "tests", until_items(kPasses * handed_on(items_of(scene, config))),
           {seed + 1000, load.out_one_in, load.out_longest}, converted, taken,
           [](const Converted& one) { return what_of(one.there, one.splat); });
  bench.run();
}

Takings clocked_ccu(const CcuWorkload& load, std::uint64_t seed) {
  const tb::TestScene scene = scene_of(load, seed);
  const GscoreConfig config = config_of(load);
  const SceneLayout& layout = scene.image.layout;
  const std::vector<CcuItem> items = items_of(scene, config);
  ClockedCcu unit(hardware_of(load, config, layout.second_halves.record_bytes), items,
                  layout.first_halves, layout.second_halves);
  ClockedFifo<std::uint64_t> passes(1);
  ClockedSink<std::uint64_t> sink({seed + 1000, load.out_one_in, load.out_longest});
  std::uint32_t begun = 0;
  for (std::uint64_t now = 0; sink.taken().size() < kPasses * handed_on(items); ++now) {
    unit.step_results();
    sink.step(unit.out, now);
    unit.step(passes);
    if (begun < kPasses && passes.has_room()) {
      passes.put(begun++);
    }
    passes.step();
  }
  return sink.taken();
}

TEST_CASE("clocked reference: culling and conversion unit") {
  Comparison table("CCU");
  const CcuConfig published;
  const PortHardware port{port_of_preset("gscore", GscoreConfig{}.memory_port)};
  PortHardware slow = port, one = port;
  slow.read_latency = 400;
  slow.config.max_outstanding = 2;
  one.config.max_outstanding = 1;
  const CcuConfig tiny = changed(published, [](CcuConfig& c) {
    c.input_slots = c.candidates = c.output_entries = 1;
    c.second_half_slots = 2;
  });
  const CcuConfig wide = changed(published, [](CcuConfig& c) {
    c.cull_lanes = 24;
    c.convert_lanes = 1000;
  });
  const CcuConfig narrow = changed(published, [](CcuConfig& c) {
    c.cull_lanes = 2;
    c.convert_lanes = 5;
  });
  const CcuConfig long_slices = changed(published, [](CcuConfig& c) { c.slice_gaussians = 16; });
  const CcuConfig single = changed(published, [](CcuConfig& c) { c.slice_gaussians = 1; });
  for (const CcuWorkload& load : {
           CcuWorkload{"light: 40 Gaussians", 40, 4, published, port},
           CcuWorkload{"heavy: 1500, few culled", 1500, 1, published, port},
           CcuWorkload{"many culled", 1500, 40, published, port},
           CcuWorkload{"slow memory", 600, 4, published, slow},
           CcuWorkload{"output stalled", 600, 4, published, port, 3, 300},
           CcuWorkload{"tiny buffers", 300, 4, tiny, one, 4, 20},
           CcuWorkload{"wide lanes", 1500, 4, wide, port},
           CcuWorkload{"wide lanes, output stalled", 600, 4, wide, port, 2, 60},
           CcuWorkload{"narrow lanes", 300, 4, narrow, port},
           CcuWorkload{"slices of 16", 600, 4, long_slices, port},
           CcuWorkload{"slices of 1", 300, 4, single, port},
           CcuWorkload{"SH degree 3", 600, 4, published, port, 1, 1, 3},
       }) {
    table.workload(load, run_ccu, clocked_ccu);
  }
}

}  // namespace
}  // namespace sgs::test
