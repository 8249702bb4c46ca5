// The rendering unit against its clocked reference: frames of several groups, splats of each token
// in turn.
#include <catch2/catch.hpp>

#include "modules/streaminggs/rendering/rendering_unit.h"
#include "testbench/units/job_memory.h"
#include "testbench/units/random_splats.h"
#include "tests/modules/clocked/comparison.h"
#include "tests/modules/streaminggs/clocked/clocked_rendering.h"

namespace sgs::test {
namespace {

struct RenderingWorkload {
  const char* name;
  std::size_t splats = 150;  // of a group
  float opacity = 1;
  std::uint32_t in_one_in = 1, in_longest = 1;
  std::uint32_t write_latency = 150;
  RenderingHardware hardware;
  std::uint32_t inputs = 4, input_entries = 20;
};

constexpr std::uint32_t kDrainPixels = 8;

StreamingJob job_of() { return tb::frame_job(150, 100, square_of(48), FrameFormat::kRgb8, 0); }

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
  config.drain_pixels_per_cycle = kDrainPixels;
  const auto lanes = [](std::uint32_t macs, std::uint32_t interval) {
    return (macs + interval - 1) / interval;
  };
  config.cluster_lanes = lanes(190, hw.blend_interval);
  config.begin_lanes = lanes(73, hw.begin_interval);
  config.span_lanes = lanes(20 * hw.rows_at_once, hw.row_interval);
  REQUIRE(config.cluster_interval_cycles() == hw.blend_interval);
  REQUIRE(config.begin_interval_cycles() == hw.begin_interval);
  REQUIRE(config.span_interval_cycles() == hw.row_interval);
  REQUIRE(config.spans_at_once() == hw.rows_at_once);
  return config;
}

// [group] in order.
std::vector<std::vector<Splat>> splats_of(const RenderingWorkload& load, const StreamingJob& job,
                                          std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<std::vector<Splat>> groups(job.groups.size());
  for (std::size_t g = 0; g < groups.size(); ++g) {
    for (std::size_t i = 0; i < load.splats; ++i) {
      groups[g].push_back(tb::random_splat(random, job.groups[g], job,
                                           static_cast<std::uint32_t>(i), load.opacity));
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

struct NoOne : sc_core::sc_module, FinishGroupIf {
  explicit NoOne(const sc_core::sc_module_name& name) : sc_module(name) {}
  void finish(std::uint32_t, std::uint32_t) override {}
};

void run(tb::Case& test, Takings& taken, const RenderingWorkload& load, std::uint64_t seed) {
  const StreamingJob job = job_of();
  tb::BenchConfig bench_config;
  bench_config.memory_bytes = tb::memory_bytes(job);
  bench_config.write_latency_cycles = load.write_latency;
  tb::UnitBench bench(test, bench_config);
  UnitContext context = bench.context(job);
  context.built_for.group = square_of(48);
  NoOne no_one("no_one");
  RenderingUnit unit("rendering", config_of(load.hardware), Arrival::kByToken, context, [&] {
    taken.push_back({bench.clock().now_cycles(), 0});
  });
  unit.finish(no_one);
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

DrainedGroup drained(const StreamingJob& job, const PixelRect& pixels, std::uint32_t subtiles,
                     std::uint32_t clusters) {
  DrainedGroup group;
  group.subtiles = subtiles;
  const auto width = static_cast<std::uint32_t>(pixels.width());
  group.row_cycles = std::max((width + kDrainPixels - 1) / kDrainPixels,
                              ((width + 3) / 4 + clusters - 1) / clusters);
  const std::uint64_t longest = MemoryPortConfig{}.max_transaction_bytes;
  for (int y = pixels.y0; y < pixels.y1; ++y) {
    const std::uint64_t begin = job.pixel_address(pixels.x0, y);
    const std::uint64_t last = begin + width * pixel_bytes(job.frame_format) - 1;
    group.row_transactions.push_back(
        static_cast<std::uint32_t>(last / longest - begin / longest + 1));
  }
  return group;
}

Takings clocked(const RenderingWorkload& load, std::uint64_t seed) {
  const StreamingJob job = job_of();
  const auto groups = splats_of(load, job, seed);
  std::vector<DrainedGroup> drains;
  std::vector<GroupState> states;
  for (const PixelRect& pixels : job.groups) {
    states.emplace_back(pixels, job.view.width, job.view.height);
    drains.push_back(drained(job, pixels, static_cast<std::uint32_t>(states.back().subtile_count()),
                             load.hardware.clusters));
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
  RenderingHardware hardware = load.hardware;
  hardware.write_latency = load.write_latency;
  ClockedRendering unit(hardware, drains);
  std::vector<ClockedFifo<RenderingItem>> in(load.inputs,
                                             ClockedFifo<RenderingItem>(load.input_entries));
  std::vector<ClockedSource<RenderingItem>> sources;
  for (std::uint32_t i = 0; i < load.inputs; ++i) {
    sources.emplace_back(std::move(items[i]), Pace(seed + i, load.in_one_in, load.in_longest));
  }
  for (std::uint64_t now = 0;; ++now) {
    unit.step(in);
    if (unit.done()) return {{now, 0}};
    for (std::uint32_t i = 0; i < load.inputs; ++i) {
      sources[i].step(in[i]);
      in[i].step();
    }
  }
}

TEST_CASE("clocked reference: rendering unit") {
  Comparison table("rendering unit");
  const RenderingHardware exact;
  RenderingHardware tiny = exact;
  tiny.queue_entries = 1;
  tiny.slots = 2;
  RenderingHardware wide = exact;
  wide.blend_interval = 1;
  wide.begin_interval = 4;
  wide.rows_at_once = 2;
  wide.row_interval = 1;
  wide.slots = 16;
  wide.queue_entries = 4;
  RenderingHardware two = exact;
  two.pixel_buffers = 2;
  for (const RenderingWorkload& load : {
           RenderingWorkload{"light: 20 splats a group", 20, 1, 1, 1, 150, exact},
           RenderingWorkload{"heavy: 300 faint splats a group", 300, 0.05F, 1, 1, 150, exact},
           RenderingWorkload{"heavy: 300 opaque splats a group", 300, 1, 1, 1, 150, exact},
           RenderingWorkload{"input stalled", 150, 0.3F, 2, 200, 150, exact},
           RenderingWorkload{"output stalled", 60, 1, 1, 1, 2000, exact},
           RenderingWorkload{"two pixel buffers", 60, 1, 1, 1, 150, two},
           RenderingWorkload{"tiny buffers", 150, 0.3F, 1, 1, 150, tiny, 1, 1},
           RenderingWorkload{"a sub-tile a cycle, two rows a cycle", 150, 0.3F, 1, 1, 150, wide},
       }) {
    table.workload(load, run, clocked);
  }
}

}  // namespace
}  // namespace sgs::test
