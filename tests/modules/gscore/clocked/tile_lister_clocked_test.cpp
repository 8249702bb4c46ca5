// The tile lister against its clocked reference: every transaction that it writes, and every tile
// that a core is given.
#include <catch2/catch.hpp>

#include "modules/gscore/gscore_datapaths.h"
#include "modules/gscore/lists/tile_lister.h"
#include "tests/modules/clocked/comparison.h"
#include "tests/modules/gscore/clocked/clocked_lister.h"
#include "tests/modules/gscore/clocked/tile_lister_workload.h"

namespace sgs::test {
namespace {

void run_tile_lister(tb::Case& test, Takings& taken, const ListerWorkload& load,
                     std::uint64_t seed) {
  tb::UnitBench bench(test, bench_of(load.port, tb::kGscoreMemoryBytes));
  GscoreConfig config = config_of(load);
  FrameJob frame;
  frame.view.width = kListerWidth;
  frame.view.height = kListerHeight;
  const ConvertedScene scene = converted_of(load, seed);
  frame.layout = tb::empty_layout(scene.gaussians);
  const GscoreJob job = tb::gscore_frame(config, bench, frame);
  auto passes = bench.add_fifos<Pass>("passes", load.ccus, 1, 1);
  auto converted = bench.add_fifos<Converted>("converted", load.ccus, 4, 1);
  auto requests = bench.add_fifos<TileRequest>("requests", load.cores, 1, 1);
  auto jobs = bench.add_fifos<TileJob>("jobs", load.cores, 1, 1);
  auto done = bench.add_fifos<PassDone>("done", load.cores, 1, 1);
  gscore::Phases phases;
  bool frame_done = false;
  TileLister unit("lister", {bench.clock(), job, config, phases},
                  [&](std::uint32_t) { frame_done = true; });
  for (auto* fifo : passes) unit.passes(*fifo);
  for (auto* fifo : converted) unit.converted(*fifo);
  for (auto* fifo : requests) unit.requests(*fifo);
  for (auto* fifo : jobs) unit.jobs(*fifo);
  for (auto* fifo : done) unit.done(*fifo);
  bench.add_unit(unit);
  for (std::uint32_t c = 0; c < load.ccus; ++c) {
    const Pace pace(seed + c, load.in_one_in, load.in_longest);
    bench.add_thread(fmt::format("ccu{}", c), [&, c, pace](Activity& activity) {
      const std::vector<Converted>& items = scene.ccus[c];
      while (!passes[c]->pop(activity).over) {
        for (std::size_t at = 0; at < items.size(); ++at) {
          bench.clock().wait_cycles(pace.gap(at));
          converted[c]->push(items[at], activity);
        }
      }
    });
  }
  bench.add_thread("watcher", [&](Activity&) {
    std::uint64_t seen = 0;
    for (std::uint64_t cycle = 0; !frame_done; ++cycle) {
      bench.wait_until_just_before(cycle + 1);
      if (unit.memory.transactions() > seen) taken.push_back({cycle, seen++});
    }
  });
  for (std::uint32_t c = 0; c < load.cores; ++c) {
    const Pace pace(seed + 1000 + c, load.core_one_in, load.core_longest);
    bench.add_thread(fmt::format("core{}", c), [&, c, pace](Activity& activity) {
      std::size_t tiles = 0;
      for (TileMark mark = TileMark::kTile; mark != TileMark::kEndOfFrame;) {
        requests[c]->push({}, activity);
        const TileJob tile = jobs[c]->pop(activity);
        mark = tile.mark;
        const bool is_tile = mark == TileMark::kTile;
        taken.push_back({bench.clock().now_cycles(),
                         is_tile ? tile_of(tile.tile, tile.entries) : tile_of(job.tile_count, 0)});
        if (is_tile)
          bench.clock().wait_cycles(pace.gap(tiles++));
        else
          done[c]->push({}, activity);
      }
    });
  }
  bench.run();
}

// A core that asks, and takes so long for a tile.
struct ClockedCore {
  Pace pace;
  std::size_t tiles = 0;
  std::uint32_t wait = 0;
  bool waits_for_tile = false, over = false;
};

struct Clocked {
  const ListerWorkload& load;
  const GscoreConfig config = config_of(load);
  TileTestHardware tests;
  ListerHardware lists;
  Takings taken;

  explicit Clocked(const ListerWorkload& of) : load(of) {
    const Datapath tile = tile_test_pipeline(config);
    tests.tile_interval = static_cast<std::uint32_t>(tile.interval_cycles());
    tests.depth = tile.depth_cycles;
    if (config.tiles.subtiles_across > 1) {
      const Datapath part = part_test_pipeline(config);
      tests.part_interval = static_cast<std::uint32_t>(part.interval_cycles());
      tests.depth += part.depth_cycles;
    }
    tests.listed_entries =
        config.lists.tested_entries + (tests.depth + tests.part_interval - 1) / tests.part_interval;
    lists.lines = config.lists.lines;
    lists.first_entries = config.blocks().first_entries();
    lists.line_entries = config.blocks().line_entries();
    lists.block_lines = config.blocks().block_lines;
    lists.record_bytes = kRecordPlaceBytes;
    lists.line_bytes = config.lists.line_bytes;
    lists.port = load.port;
  }

  void run(std::uint64_t seed) {
    const ConvertedScene scene = converted_of(load, seed);
    const auto all = static_cast<std::uint32_t>(((kListerWidth + kTilePx - 1) / kTilePx) *
                                                ((kListerHeight + kTilePx - 1) / kTilePx));
    const std::uint32_t slice = config.ccu.slice_gaussians;
    ClockedTileTests tester(tests, (scene.gaussians + slice - 1) / slice);
    ClockedLister lister(lists, std::min(config.lists.tiles, all), all);
    std::vector<ClockedFifo<ClockedGaussian>> in(load.ccus, ClockedFifo<ClockedGaussian>(4));
    std::vector<ClockedFifo<std::uint64_t>> requests(load.cores, ClockedFifo<std::uint64_t>(1));
    auto jobs = requests, done = requests;
    std::vector<ClockedSource<ClockedGaussian>> ccus;
    std::vector<ClockedCore> cores;
    for (std::uint32_t c = 0; c < load.cores; ++c) {
      cores.push_back({Pace(seed + 1000 + c, load.core_one_in, load.core_longest)});
    }
    std::uint64_t writes = 0;
    for (std::uint64_t now = 0; !std::all_of(cores.begin(), cores.end(),
                                             [](const ClockedCore& core) { return core.over; });
         ++now) {
      for (std::uint32_t c = 0; c < load.cores; ++c) {
        step_core(cores[c], now, jobs[c], requests[c], done[c], now > 0 && lister.end() == all);
      }
      lister.step(tester.out, requests, jobs, done, tile_of);
      if (lister.wrote()) taken.push_back({now, writes++});
      tester.step(in);
      for (std::uint32_t c = 0; c < ccus.size(); ++c) ccus[c].step(in[c]);
      if (lister.begins()) {
        ccus.clear();
        for (std::uint32_t c = 0; c < load.ccus; ++c) {
          std::vector<ClockedGaussian> gaussians;
          for (const Converted& one : scene.ccus[c]) {
            gaussians.push_back(gaussian_of(one, config, lister.first(), lister.end()));
          }
          ccus.emplace_back(std::move(gaussians), Pace(seed + c, load.in_one_in, load.in_longest));
        }
      }
      for (auto& fifo : in) fifo.step();
      for (auto* fifos : {&requests, &jobs, &done}) {
        for (auto& fifo : *fifos) fifo.step();
      }
    }
  }
  void step_core(ClockedCore& core, std::uint64_t now, ClockedFifo<std::uint64_t>& jobs,
                 ClockedFifo<std::uint64_t>& requests, ClockedFifo<std::uint64_t>& done,
                 bool last_pass) {
    if (core.over || (core.wait > 0 && --core.wait > 0)) return;
    if (core.waits_for_tile) {
      if (!jobs.can_take()) return;
      const std::uint64_t what = jobs.take();
      taken.push_back({now, what});
      core.waits_for_tile = false;
      if (what >> 32U < 104) {
        core.wait = core.pace.gap(core.tiles++);
        return;
      }
      done.put(0);
      core.over = last_pass;
      if (core.over) return;
    }
    if (!requests.has_room()) return;
    requests.put(0);
    core.waits_for_tile = true;
  }
};

TEST_CASE("clocked reference: tile lister") {
  Comparison table("tile lister");
  ListsConfig tiny = lists_config(4);
  tiny.tested_entries = 1;
  const PortHardware port{port_of_preset("gscore", GscoreConfig{}.memory_port)};
  PortHardware fast = port, one = port;
  fast.write_latency = 20;
  one.write_latency = 40;
  one.config.max_writes = 1;
  PortHardware faster = port;
  faster.write_latency = 5;
  ListsConfig quarter = lists_config(104);
  quarter.tile_lanes = 5;
  quarter.part_lanes = 6;
  for (const ListerWorkload& load : {
           ListerWorkload{"light: 20 Gaussians", 20, lists_config(104), 1, 1, 1, 1, port},
           ListerWorkload{"heavy: 1500 Gaussians", 1500, lists_config(104), 1, 1, 1, 1, port},
           ListerWorkload{"tiles that share lines", 400, lists_config(7), 1, 1, 1, 1, port},
           ListerWorkload{"passes of 30 tiles", 300, lists_config(104, 30), 1, 1, 1, 1, port},
           ListerWorkload{"input stalled", 400, lists_config(104), 3, 60, 1, 1, port},
           ListerWorkload{"cores stalled", 100, lists_config(104), 1, 1, 2, 200, port},
           ListerWorkload{"fast memory", 400, lists_config(104), 1, 1, 1, 1, fast},
           ListerWorkload{"tests bind", 400, lists_config(104), 1, 1, 1, 1, faster},
           ListerWorkload{"tests bind, no parts", 400, lists_config(104), 1, 1, 1, 1, faster, 4, 4,
                          1},
           ListerWorkload{"tests bind, a quarter of lanes", 400, quarter, 1, 1, 1, 1, faster},
           ListerWorkload{"tiny buffers", 200, tiny, 4, 20, 4, 20, one, 1, 1},
       }) {
    table.workload(load, run_tile_lister, [](const ListerWorkload& of, std::uint64_t seed) {
      Clocked clocked(of);
      clocked.run(seed);
      return clocked.taken;
    });
  }
}

}  // namespace
}  // namespace sgs::test
