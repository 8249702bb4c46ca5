// Rendering core of the tile-centric machine alone: sorted entries in, records and a frame buffer
// in memory. Checked against GroupState; busy cycles against closed forms, to the cycle where no
// splat waits for another.
#include <algorithm>

#include "algorithm/render/tile_renderer.h"
#include "modules/datapath/work_rates.h"
#include "modules/gscore/gscore_datapaths.h"
#include "modules/gscore/rendering/render_core.h"
#include "testbench/units/gscore_bench.h"
#include "testbench/units/random_scene.h"

namespace sgs::tb {
namespace {

struct Plan {
  GscoreConfig config;
  int width_px = 64, height_px = 32;
  std::vector<Splat> records;
  std::vector<std::vector<SortedEntry>> tiles;  // [tile] in order
};

std::uint32_t tile_count(const Plan& plan) {
  return static_cast<std::uint32_t>((plan.width_px + 15) / 16 * ((plan.height_px + 15) / 16));
}

Plan make_plan(const GscoreConfig& config, std::mt19937_64& random, int width_px, int height_px,
               std::size_t entries, float opacity, bool whole_tiles) {
  Plan plan;
  plan.config = config;
  plan.width_px = width_px;
  plan.height_px = height_px;
  plan.tiles.resize(tile_count(plan));
  FrameJob frame;
  frame.view.width = width_px;
  frame.view.height = height_px;
  const auto groups = pixel_groups(width_px, height_px, square_of(kTilePx));
  const std::uint32_t parts = 1U << (config.tiles.subtiles_across * config.tiles.subtiles_across);
  for (std::uint32_t t = 0; t < plan.tiles.size(); ++t) {
    for (std::size_t e = 0; e < entries; ++e) {
      const auto number = static_cast<std::uint32_t>(plan.records.size());
      const Splat splat = random_splat(random, groups[t], frame, number, opacity);
      plan.records.push_back(splat);
      const std::uint32_t bitmap =
          whole_tiles ? parts - 1 : 1 + static_cast<std::uint32_t>(random() % (parts - 1));
      plan.tiles[t].push_back({EntryMark::kEntry, t, number, bitmap,
                               listed_opacity(config.tiles.features, splat.opacity)});
    }
  }
  return plan;
}

struct Expected {
  std::vector<std::byte> frame;
  std::uint64_t contributors = 0, finished = 0, finished_pixels = 0;
};

Expected expect(const Plan& plan, const GscoreJob& job) {
  Expected out;
  const NumberFormat format = plan.config.tiles.features;
  RenderResult frame(plan.width_px, plan.height_px);
  for (std::uint32_t t = 0; t < plan.tiles.size(); ++t) {
    GroupState state(job.pixels(t), plan.width_px, plan.height_px, plan.config.rendering.precision,
                     SubtileTest::kBox);
    for (const SortedEntry& entry : plan.tiles[t]) {
      std::byte bytes[kRecordPlaceBytes];
      encode_projected(format, plan.records[entry.record], bytes);
      with_record(
          format, plan.config.rendering.precision, bytes, entry.opacity, [&](const auto& splat) {
            for_each_part(plan.config.tiles.rules(), job.tile_x(t), job.tile_y(t), entry.bitmap,
                          splat, [&](const auto& part, int) { state.blend(part); });
          });
    }
    state.store(job.background, frame);
    out.contributors += state.contributors();
    out.finished += state.saturated() ? 1 : 0;
    out.finished_pixels += state.finished_pixels();
  }
  out.frame = encode_frame(plan.config.framebuffer, frame.image);
  return out;
}

// Bits of parts that entries bring, and of these of parts without a pixel of the frame.
struct Bits {
  std::uint64_t all = 0, outside = 0;
};

Bits bits_of(const Plan& plan, const GscoreJob& job) {
  Bits out;
  const int across = plan.config.tiles.subtiles_across, side = kTilePx / across;
  for (std::uint32_t t = 0; t < plan.tiles.size(); ++t) {
    for (const SortedEntry& entry : plan.tiles[t]) {
      for (int part = 0; part < across * across; ++part) {
        if ((entry.bitmap >> part & 1) == 0) continue;
        ++out.all;
        const int x = job.tile_x(t) * kTilePx + part % across * side;
        const int y = job.tile_y(t) * kTilePx + part / across * side;
        out.outside += x >= plan.width_px || y >= plan.height_px ? 1 : 0;
      }
    }
  }
  return out;
}

// Each row of a tile by itself: a turn of the lanes for each of its pixels that are read at once
// where tiles share memories; with one port a pixel is cleared in a cycle of its own.
std::uint64_t drain_cycles(const Plan& plan) {
  const std::uint64_t turn = blend_pipeline(plan.config).interval_cycles();
  const bool shared = plan.config.rendering.pixel_buffers == 2;
  std::uint64_t cycles_of_row = 0;
  for (int x = 0; x < plan.width_px; x += kTilePx) {
    const auto width = static_cast<std::uint64_t>(std::min(kTilePx, plan.width_px - x));
    const std::uint64_t at_once = cycles_for(width, plan.config.rendering.drain_pixels_per_cycle);
    const std::uint64_t of_port = turn > 1 ? 2 * cycles_for(width, 4) : 0;
    cycles_of_row += shared ? turn * at_once : std::max(at_once, of_port);
  }
  return cycles_of_row * static_cast<std::uint64_t>(plan.height_px);
}

void run_plan(Case& test, const BenchConfig& bench_config, Plan plan, bool no_hazards = false) {
  UnitBench bench(test, bench_config);
  Checks& checks = bench.checks();
  FrameJob frame;
  frame.view.width = plan.width_px;
  frame.view.height = plan.height_px;
  frame.layout = empty_layout(static_cast<std::uint32_t>(plan.records.size()));
  const GscoreJob job = gscore_frame(plan.config, bench, frame);
  const NumberFormat format = plan.config.tiles.features;
  std::vector<std::byte> records(plan.records.size() * kRecordPlaceBytes);
  for (std::size_t r = 0; r < plan.records.size(); ++r) {
    encode_projected(format, plan.records[r], records.data() + r * kRecordPlaceBytes);
  }
  bench.load(job.projected.base, records);
  auto& sorted = bench.add_fifo<SortedEntry>("sorted", 8, 1);
  auto& done = bench.add_fifo<PassDone>("done", 1, 1);
  FinishedTiles finished("finished_tiles", bench.clock(), plan.tiles.size(), 1);
  gscore::Phases phases;
  RenderCore unit("rendering", {bench.clock(), job, plan.config, phases}, finished);
  phases.drawing.begin();
  unit.sorted(sorted);
  unit.done(done);
  bench.add_unit(unit);
  std::uint64_t entries = 0;
  bench.add_thread("sorter", [&](Activity& activity) {
    for (std::uint32_t t = 0; t < plan.tiles.size(); ++t) {
      for (const SortedEntry& entry : plan.tiles[t]) {
        sorted.push(entry, activity);
        ++entries;
      }
      sorted.push({EntryMark::kEndOfTile, t}, activity);
    }
    sorted.push({EntryMark::kEndOfFrame}, activity);
  });
  bench.add_thread("lister", [&](Activity& activity) { done.pop(activity); });
  bench.run();

  const Expected expected = expect(plan, job);
  checks.that(bench.read_back(job.frame_buffer.base, expected.frame.size()) == expected.frame,
              "the frame");
  bench.check_counter("contributors", expected.contributors);
  bench.check_counter("tiles_finished", expected.finished);
  bench.check_counter("tiles", plan.tiles.size());
  checks.equal(bench.counter("records") + bench.counter("dropped"), entries, "entries taken");
  checks.equal(bench.counter("splats") + bench.counter("dropped_fetched"), bench.counter("records"),
               "records looked at");
  checks.equal(bench.bytes_read(), std::uint64_t{record_bytes(format)} * bench.counter("records"),
               "bytes read");
  const std::uint64_t blocks = bench.counter("blocks");
  const std::uint64_t interval = blend_pipeline(plan.config).interval_cycles();
  checks.that(bench.busy_cycles("rendering") >= blocks * interval, "rendering's bound");
  const Bits bits = bits_of(plan, job);
  const std::uint64_t dropped = bench.counter("dropped"), late = bench.counter("dropped_fetched"),
                      skipped = bench.counter("parts_finished");
  if (dropped + late == 0) {
    checks.equal(bench.counter("parts") + skipped, bits.all, "parts with a bit");
    checks.that(skipped >= bits.outside, "parts outside the frame");
    if (!plan.config.rendering.skip_finished) {
      checks.equal(skipped, bits.outside, "parts_finished");
    }
  }
  const std::uint64_t splats = bench.counter("splats"), fetched = bench.counter("records"),
                      pixels = std::uint64_t(plan.width_px) * std::uint64_t(plan.height_px);
  bench.check_counter("pixels", pixels);
  bench.check_accesses("records", fetched, fetched);
  bench.check_accesses("finished parts", splats, splats);
  bench.check_accesses("pixel state", expected.contributors + expected.finished_pixels + pixels,
                       expected.contributors + pixels);
  bench.check_accesses("finished pixels", 16 * blocks,
                       expected.finished_pixels + 256 * plan.tiles.size());
  bench.check_operations("rendering", "comparator", blocks);
  // A cycle for what is fetched or dropped, each tile's end and the frame's.
  checks.equal(bench.busy_cycles("record fetch"), entries + plan.tiles.size() + 1,
               "cycles of fetching");
  const std::uint64_t blending =
      blocks * interval + bench.counter("hazard_cycles") + late + plan.tiles.size() + 1;
  checks.that(bench.busy_cycles("rendering") >= blending, "cycles of rendering at least");
  // One more for a splat of finished parts; behind any splat, until the lanes' next turn, and until
  // those of conics have theirs.
  const std::optional<Datapath> conic = conic_pipeline(plan.config);
  const std::uint64_t pace = interval - 1 + (conic ? conic->interval_cycles() : 0);
  checks.that(bench.busy_cycles("rendering") <= blending + skipped + pace * splats,
              "cycles of rendering at most");
  checks.equal(bench.busy_cycles("drain"), drain_cycles(plan) + 1, "cycles of draining");
  const std::uint64_t parts =
      std::uint64_t(plan.config.tiles.subtiles_across) * plan.config.tiles.subtiles_across;
  checks.equal((blocks + bench.counter("blocks_finished")) * parts, 16 * bench.counter("parts"),
               "blocks of 16 px");
  if (!no_hazards) return;
  bench.check_counter("hazard_cycles", 0);
  checks.equal(bench.busy_cycles("rendering"), blocks * interval + plan.tiles.size() + 1,
               "cycles of rendering");
}

void random_case(Case& test) {
  std::mt19937_64& random = test.random;
  GscoreConfig config = random_gscore(random);
  config.rendering.drain_pixels_per_cycle = 1 + static_cast<std::uint32_t>(random() % 4);
  if (random() % 2 == 0)
    config.rendering.core_lanes = 40 + static_cast<std::uint32_t>(random() % 200);
  constexpr float kOpacities[] = {0.02F, 0.5F, 1.0F};
  run_plan(test, random_bench(random, kGscoreMemoryBytes),
           make_plan(config, random, 1 + static_cast<int>(random() % 70),
                     1 + static_cast<int>(random() % 40), random() % 60, kOpacities[random() % 3],
                     random() % 3 == 0));
}

}  // namespace
}  // namespace sgs::tb

int sc_main(int argc, char* argv[]) {
  using namespace sgs;
  using namespace sgs::tb;
  CaseRunner runner("tb_render_core", "Rendering core of a tile-centric machine alone");
  const auto directed = [&](const char* name, int width, int height, std::size_t entries,
                            float opacity, bool whole_tiles) {
    runner.add_directed(name, [=](Case& test) {
      GscoreConfig config;
      config.cores = 1;
      config.lists.pool_bytes = 1 << 20;
      run_plan(test, still_bench(kGscoreMemoryBytes),
               make_plan(config, test.random, width, height, entries, opacity, whole_tiles),
               whole_tiles && opacity < 0.1F);
    });
  };
  directed("tiles without entries", 64, 48, 0, 1, false);
  directed("one entry a tile", 64, 48, 1, 1, false);
  directed("1x1 frame", 1, 1, 5, 1, false);
  directed("tiles cut by the frame's edge", 70, 33, 20, 1, false);
  directed("whole tiles: a splat never waits for another", 64, 48, 40, 0.05F, true);
  directed("tiles that finish", 32, 32, 300, 1, true);
  runner.set_random(random_case);
  return runner.run(argc, argv);
}
