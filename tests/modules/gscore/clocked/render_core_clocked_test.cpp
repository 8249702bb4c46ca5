// The rendering core of a tile-centric machine against its clocked reference: every transaction of
// pixels, so the end of every tile, and the end of the frame.
#include <catch2/catch.hpp>

#include "modules/gscore/rendering/render_core.h"
#include "tests/modules/clocked/comparison.h"
#include "tests/modules/gscore/clocked/render_core_workload.h"

namespace sgs::test {
namespace {

constexpr std::uint64_t kFrameDone = ~std::uint64_t{0};

struct CoreBench {
  tb::UnitBench bench;
  GscoreConfig config;
  GscoreJob job;
  CoreBench(tb::Case& test, const CoreWorkload& load, std::size_t records)
      : bench(test, bench_of(load.hardware.port, tb::kGscoreMemoryBytes)), config(config_of(load)) {
    FrameJob frame;
    frame.view.width = kCoreWidth;
    frame.view.height = kCoreHeight;
    frame.layout = tb::empty_layout(static_cast<std::uint32_t>(records));
    job = tb::gscore_frame(config, bench, frame);
  }
};

void run_render_core(tb::Case& test, Takings& taken, const CoreWorkload& load, std::uint64_t seed) {
  const CorePlan plan = plan_of(load, config_of(load), seed);
  CoreBench own(test, load, plan.records.size());
  tb::UnitBench& bench = own.bench;
  std::vector<std::byte> records(plan.records.size() * kRecordPlaceBytes);
  for (std::size_t r = 0; r < plan.records.size(); ++r) {
    encode_projected(own.config.tiles.features, plan.records[r],
                     records.data() + r * kRecordPlaceBytes);
  }
  bench.load(own.job.projected.base, records);
  auto& sorted = bench.add_fifo<SortedEntry>("sorted", load.sorted_entries, 1);
  auto& done = bench.add_fifo<PassDone>("done", 1, 1);
  FinishedTiles finished("finished_tiles", bench.clock(), plan.tiles.size(),
                         load.hardware.feedback);
  gscore::Phases phases;
  RenderCore unit("rendering", {bench.clock(), own.job, own.config, phases}, finished);
  phases.drawing.begin();
  unit.sorted(sorted);
  unit.done(done);
  bench.add_unit(unit);
  add_source(bench, "sorter", stream_of(plan), {seed, load.in_one_in, load.in_longest}, sorted);
  bool frame_done = false;
  bench.add_thread("watcher", [&](Activity&) {
    for (std::uint64_t cycle = 0; !frame_done; ++cycle) {
      bench.wait_until_just_before(cycle + 1);
      if (unit.pixel_memory.transactions() > taken.size()) taken.push_back({cycle, taken.size()});
    }
  });
  bench.add_thread("lister", [&](Activity& activity) {
    done.pop(activity);
    frame_done = true;
    taken.push_back({bench.clock().now_cycles(), kFrameDone});
  });
  bench.run();
}

Takings clocked_render_core(const CoreWorkload& load, std::uint64_t seed) {
  const GscoreConfig config = config_of(load);
  const CorePlan plan = plan_of(load, config, seed);
  FrameJob frame;
  frame.view.width = kCoreWidth;
  frame.view.height = kCoreHeight;
  frame.frame_format = config.framebuffer;
  frame.layout = tb::empty_layout(static_cast<std::uint32_t>(plan.records.size()));
  add_regions(config, frame);
  const GscoreJob job = gscore_job(config, frame);
  ClockedRenderCore unit(scheduled(load, config), tiles_of(job, load.hardware));
  ClockedFifo<CoreItem> sorted(load.sorted_entries);
  ClockedSource<CoreItem> source(items_of(plan, config, job),
                                 {seed, load.in_one_in, load.in_longest});
  Takings taken;
  for (std::uint64_t now = 0;; ++now) {
    if (unit.done()) {
      taken.push_back({now, kFrameDone});
      return taken;
    }
    if (unit.step(sorted)) taken.push_back({now, taken.size()});
    source.step(sorted);
    sorted.step();
  }
}

TEST_CASE("clocked reference: rendering core") {
  Comparison table("rendering core");
  CoreHardware published;
  published.port = {port_of_preset("gscore", GscoreConfig{}.memory_port)};
  const CoreHardware tiny =
      changed(published, [](CoreHardware& h) { h.record_slots = h.pixel_buffers = 1; });
  const CoreHardware slow_memory =
      changed(published, [](CoreHardware& h) { h.port.read_latency = 300; });
  const CoreHardware slow_writes =
      changed(published, [](CoreHardware& h) { h.port.config.max_writes = 1; });
  const CoreHardware few_lanes = changed(published, [](CoreHardware& h) { h.blend_interval = 3; });
  const CoreHardware few_lanes_one_buffer =
      changed(few_lanes, [](CoreHardware& h) { h.pixel_buffers = 1; });
  const CoreHardware fine_parts = changed(published, [](CoreHardware& h) { h.parts_across = 4; });
  const CoreHardware whole = changed(published, [](CoreHardware& h) { h.parts_across = 1; });
  const CoreHardware all_blended =
      changed(published, [](CoreHardware& h) { h.skip_finished = false; });
  const CoreHardware late_news = changed(published, [](CoreHardware& h) { h.feedback = 40; });
  for (const CoreWorkload& load : {
           CoreWorkload{"light: 4 entries a tile", 4, 0.3F, false, published},
           CoreWorkload{"heavy: 200 faint, whole tiles", 200, 0.05F, true, published},
           CoreWorkload{"heavy: 400 opaque", 400, 1, false, published},
           CoreWorkload{"input stalled", 60, 0.3F, false, published, 3, 90},
           CoreWorkload{"slow memory", 100, 1, false, slow_memory},
           CoreWorkload{"a write at a time", 20, 0.3F, false, slow_writes},
           CoreWorkload{"tiny buffers", 30, 1, false, tiny, 4, 20, 1},
           CoreWorkload{"16 px every 3 cycles", 200, 1, false, few_lanes},
           CoreWorkload{"16 px every 3 cycles, one tile", 200, 1, false, few_lanes_one_buffer},
           CoreWorkload{"light: 16 px every 3 cycles", 4, 0.3F, false, few_lanes},
           CoreWorkload{"16 parts", 200, 1, false, fine_parts},
           CoreWorkload{"tiles without parts", 200, 1, true, whole},
           CoreWorkload{"finished parts blended too", 300, 1, false, all_blended},
           CoreWorkload{"news of finished tiles late", 400, 1, false, late_news},
           CoreWorkload{"single precision, pixels in floats", 100, 1, false, published, 1, 1, 8,
                        BlendPrecision::kSingle, FrameFormat::kRgb32f},
       }) {
    table.workload(load, run_render_core, clocked_render_core);
  }
}

}  // namespace
}  // namespace sgs::test
