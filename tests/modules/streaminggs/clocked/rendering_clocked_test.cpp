// The rendering unit against its clocked reference: frames of several groups, splats of each token
// in turn; when groups are known to be finished, and the end of the frame.
#include <catch2/catch.hpp>

#include "modules/streaminggs/exact_config.h"
#include "modules/streaminggs/paper_config.h"
#include "modules/streaminggs/rendering/rendering_unit.h"
#include "testbench/units/job_memory.h"
#include "testbench/units/random_scene.h"
#include "tests/modules/clocked/comparison.h"
#include "tests/modules/streaminggs/clocked/clocked_rendering.h"

namespace sgs::test {
namespace {

struct RenderingWorkload {
  const char* name;
  std::size_t splats = 150;  // of a group
  float opacity = 1;
  std::uint32_t in_one_in = 1, in_longest = 1;
  RenderingHardware hardware;
  PixelSize group = preset_of<ExactConfig>("exact").group;
  std::uint32_t inputs = 4, input_entries = 20;
  bool curtains = false;  // half way through each group's splats
};

constexpr std::uint32_t kDrainPixels = 8;

// Three groups, behind each row of them one that the frame's edge cuts.
StreamingJob job_of(const RenderingWorkload& load) {
  return tb::frame_job(3 * load.group.width / 2, 3 * load.group.height / 2, load.group,
                       FrameFormat::kRgb8, 0);
}

// Lanes that give the hardware's intervals.
RenderingConfig config_of(const RenderingHardware& hw) {
  RenderingConfig config;
  config.clusters = hw.clusters;
  config.cluster_queue_entries = hw.queue_entries;
  config.depth_cycles = hw.depth;
  config.state_loop_cycles = hw.state_loop;
  config.begin_depth_cycles = hw.begin_depth;
  config.span_depth_cycles = hw.row_depth;
  config.drain_depth_cycles = hw.drain_depth;
  config.span_slots = hw.slots;
  config.pixel_buffers = hw.pixel_buffers;
  config.pixel_ports = hw.one_port ? 1 : 2;
  config.drain_pixels_per_cycle = kDrainPixels;
  const auto lanes = [](std::uint32_t macs, std::uint32_t interval) {
    return (macs + interval - 1) / interval;
  };
  config.cluster_lanes = lanes(167, hw.blend_interval);
  config.begin_lanes = lanes(71, hw.begin_interval);
  config.span_lanes = lanes(19 * hw.rows_at_once, hw.row_interval);
  REQUIRE(config.cluster_interval_cycles() == hw.blend_interval);
  REQUIRE(config.begin_interval_cycles() == hw.begin_interval);
  REQUIRE(config.span_interval_cycles() == hw.row_interval);
  REQUIRE(config.spans_at_once() == hw.rows_at_once);
  return config;
}

// Flat and opaque: three finish every pixel of a group.
Splat curtain(const StreamingJob& job, std::uint32_t index) {
  Splat splat{};
  splat.conic_a = splat.conic_c = 1e-12F;
  splat.opacity = splat.depth = 1;
  splat.index = index;
  splat.footprint = tb::subtiles_of({0, 0, job.view.width, job.view.height});
  return splat;
}

// [group] in order.
std::vector<std::vector<Splat>> splats_of(const RenderingWorkload& load, const StreamingJob& job,
                                          std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<std::vector<Splat>> groups(job.groups.size());
  for (std::size_t g = 0; g < groups.size(); ++g) {
    for (std::size_t i = 0; i < load.splats; ++i) {
      const auto index = static_cast<std::uint32_t>(i);
      const bool hides = load.curtains && i >= load.splats / 2 && i < load.splats / 2 + 4;
      groups[g].push_back(hides
                              ? curtain(job, index)
                              : tb::random_splat(random, job.groups[g], job, index, load.opacity));
    }
  }
  return groups;
}

// [FIFO] every token in turn.
std::vector<std::vector<SplatToken>> tokens_of(const RenderingWorkload& load,
                                               const std::vector<std::vector<Splat>>& groups) {
  std::vector<std::vector<SplatToken>> tokens(load.inputs);
  std::size_t turn = 0;
  for (std::uint32_t g = 0; g < groups.size(); ++g) {
    for (const Splat& splat : groups[g]) {
      const Mark mark = splat.index % 8 == 7 ? Mark::kRejected : Mark::kNone;
      tokens[turn++ % load.inputs].push_back({splat, g, 0, mark});
    }
    tokens[turn++ % load.inputs].push_back({{}, g, 0, Mark::kEndOfGroup});
  }
  return tokens;
}

// What is told of a group; of the frame's end it is 0.
std::uint64_t what_of(std::uint32_t finished_group) { return 1 + finished_group; }

struct Listener : sc_core::sc_module, FinishGroupIf {
  Listener(const sc_core::sc_module_name& name, const ClockDomain& clock, Takings& taken)
      : sc_module(name), clock_(clock), taken_(taken) {}
  void finish(std::uint32_t group, std::uint32_t known_in_cycles) override {
    taken_.push_back({clock_.now_cycles() + known_in_cycles, what_of(group)});
  }

 private:
  const ClockDomain& clock_;
  Takings& taken_;
};

void run_rendering(tb::Case& test, Takings& taken, const RenderingWorkload& load,
                   std::uint64_t seed) {
  const StreamingJob job = job_of(load);
  tb::UnitBench bench(test, bench_of(load.hardware.port, tb::memory_bytes(job)));
  UnitContext context = bench.context(job);
  context.built_for.group = load.group;
  Listener listener("listener", bench.clock(), taken);
  RenderingUnit unit("rendering", config_of(load.hardware), Arrival::kByToken, context,
                     [&](std::uint32_t) {
                       taken.push_back({bench.clock().now_cycles(), 0});
                     });
  unit.finish(listener);
  const auto inputs = bench.add_fifos<SplatToken>("splats", load.inputs, load.input_entries, 1);
  for (TimedFifo<SplatToken>* input : inputs) unit.splats(*input);
  bench.add_unit(unit);
  const auto tokens = tokens_of(load, splats_of(load, job, seed));
  for (std::uint32_t i = 0; i < load.inputs; ++i) {
    add_source(bench, fmt::format("hfu{}", i), tokens[i],
               {seed + i, load.in_one_in, load.in_longest}, *inputs[i]);
  }
  bench.run();
}

RenderingItem item_of(const SplatToken& token, GroupState& state, std::uint32_t clusters) {
  RenderingItem item;
  item.is_splat = token.mark == Mark::kNone;
  item.ends_group = token.mark == Mark::kEndOfGroup;
  if (!item.is_splat) return item;
  const SubtileRect box = state.box_of(token.splat).subtiles;
  for (std::size_t y = box.y0; y < box.y1; ++y) {
    for (std::size_t x = box.x0; x < box.x1; ++x) {
      item.footprint.push_back(static_cast<std::uint32_t>(y * state.subtile_columns() + x));
    }
  }
  const BlendWork work = state.blend_scheduled(token.splat, [&](const SubtileReach& reach) {
    item.reaches.push_back({static_cast<std::uint32_t>(reach.at), reach.row,
                            static_cast<std::uint32_t>(reach.x + 2 * reach.y) % clusters,
                            reach.finishes});
  });
  item.rows = work.rows;
  item.spans = work.spans;
  return item;
}

// A cluster's port gives the row's pixels of a sub-tile; the only one then clears them.
DrainedGroup drained(const StreamingJob& job, const PixelRect& pixels, std::uint32_t subtiles,
                     const RenderingHardware& hw) {
  DrainedGroup group;
  group.subtiles = subtiles;
  const auto width = static_cast<std::uint32_t>(pixels.width());
  const std::uint32_t accesses = ((width + 3) / 4 + hw.clusters - 1) / hw.clusters;
  group.row_cycles =
      std::max((width + kDrainPixels - 1) / kDrainPixels, (hw.one_port ? 2 : 1) * accesses);
  for (int y = pixels.y0; y < pixels.y1; ++y) {
    group.rows.push_back(
        {job.pixel_address(pixels.x0, y), std::uint64_t{width} * pixel_bytes(job.frame_format)});
  }
  return group;
}

Takings clocked_rendering(const RenderingWorkload& load, std::uint64_t seed) {
  const StreamingJob job = job_of(load);
  const auto groups = splats_of(load, job, seed);
  std::vector<DrainedGroup> drains;
  std::vector<GroupState> states;
  for (const PixelRect& pixels : job.groups) {
    states.emplace_back(pixels, job.view.width, job.view.height);
    drains.push_back(drained(job, pixels, static_cast<std::uint32_t>(states.back().subtile_count()),
                             load.hardware));
  }
  // What a splat finishes depends on those before it: they are drawn in the order of the groups.
  const auto tokens = tokens_of(load, groups);
  std::vector<std::vector<RenderingItem>> items(load.inputs);
  std::vector<std::size_t> next(load.inputs, 0);
  std::size_t count = 0, turn = 0;
  for (const auto& of_input : tokens) count += of_input.size();
  for (; turn < count; ++turn) {
    const std::size_t i = turn % load.inputs;
    const SplatToken& token = tokens[i][next[i]++];
    items[i].push_back(item_of(token, states[token.group], load.hardware.clusters));
  }
  ClockedRendering unit(load.hardware, drains);
  std::vector<ClockedFifo<RenderingItem>> in(load.inputs,
                                             ClockedFifo<RenderingItem>(load.input_entries));
  std::vector<ClockedSource<RenderingItem>> sources;
  for (std::uint32_t i = 0; i < load.inputs; ++i) {
    sources.emplace_back(std::move(items[i]), Pace(seed + i, load.in_one_in, load.in_longest));
  }
  for (std::uint64_t now = 0;; ++now) {
    unit.step(in);
    if (unit.done()) {
      Takings taken;
      for (const GroupNews& news : unit.finished())
        taken.push_back({news.cycle, what_of(news.group)});
      taken.push_back({now, 0});
      return taken;
    }
    for (std::uint32_t i = 0; i < load.inputs; ++i) {
      sources[i].step(in[i]);
      in[i].step();
    }
  }
}

TEST_CASE("clocked reference: rendering unit") {
  Comparison table("rendering unit");
  RenderingHardware exact;
  exact.port = {preset_of<ExactConfig>("exact").port, 40, 20};
  RenderingHardware late = exact;
  late.port.write_latency = 300;
  RenderingHardware tiny = exact;
  tiny.queue_entries = 1;
  tiny.slots = 2;
  RenderingHardware wide = exact;
  wide.port.config = preset_of<PaperConfig>("paper").port;
  wide.blend_interval = 1;
  wide.begin_interval = 4;
  wide.rows_at_once = 2;
  wide.row_interval = 1;
  wide.slots = 16;
  wide.queue_entries = 4;
  RenderingHardware two = exact;
  two.pixel_buffers = 2;
  RenderingHardware one_port = exact;
  one_port.one_port = true;
  RenderingHardware one_port_in_two = one_port;
  one_port_in_two.blend_interval = 2;
  one_port_in_two.state_loop = 10;
  one_port_in_two.clusters = 2;
  const PixelSize of_exact = preset_of<ExactConfig>("exact").group;
  for (const RenderingWorkload& load : {
           RenderingWorkload{"light: 20 splats a group", 20, 1, 1, 1, exact},
           RenderingWorkload{"heavy: 300 faint splats a group", 300, 0.05F, 1, 1, exact},
           RenderingWorkload{"heavy: 300 opaque splats a group", 300, 1, 1, 1, exact},
           RenderingWorkload{"input stalled", 150, 0.3F, 2, 200, exact},
           RenderingWorkload{"output stalled", 60, 1, 1, 1, late},
           RenderingWorkload{"two pixel buffers", 60, 1, 1, 1, two},
           RenderingWorkload{"one port, three cycles a sub-tile", 300, 1, 1, 1, one_port},
           RenderingWorkload{"one port, two cycles, two clusters", 300, 1, 1, 1, one_port_in_two},
           RenderingWorkload{"groups that finish", 150, 0.3F, 1, 1, exact, of_exact, 4, 20, true},
           RenderingWorkload{"tiny buffers", 150, 0.3F, 1, 1, tiny, of_exact, 1, 1},
           RenderingWorkload{"as of paper: a sub-tile a cycle, two rows a cycle", 300, 1, 1, 1,
                             wide, preset_of<PaperConfig>("paper").group},
       }) {
    table.workload(load, run_rendering, clocked_rendering);
  }
}

TEST_CASE("clocked reference: a blend's write in a cycle of reads") {
  RenderingWorkload load{"one port, written too early", 300, 1, 1, 1, {}};
  load.hardware.one_port = true;
  load.hardware.state_loop = 10;  // read in cycles 0, 3, 6; written in 9
  load.hardware.port = {preset_of<ExactConfig>("exact").port, 40, 20};
  CHECK_THROWS_AS(clocked_rendering(load, 1), std::logic_error);
}

}  // namespace
}  // namespace sgs::test
