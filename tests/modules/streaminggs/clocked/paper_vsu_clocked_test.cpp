// VSU of paper order against its clocked reference.
#include <catch2/catch.hpp>
#include <optional>

#include "modules/streaminggs/paper_config.h"
#include "modules/streaminggs/vsu/paper_vsu.h"
#include "testbench/units/job_memory.h"
#include "testbench/units/paper_vsu_plan.h"
#include "tests/modules/clocked/comparison.h"
#include "tests/modules/streaminggs/clocked/clocked_paper_vsu.h"
#include "tests/modules/streaminggs/clocked/group_numbers_hardware.h"

namespace sgs::test {
namespace {

struct PaperVsuWorkload {
  const char* name;
  std::size_t gaussians = 1500;
  std::uint32_t out_one_in = 1, out_longest = 1;
  PaperVsuHardware hardware;
  std::uint32_t entries = kVisitFifoEntries, hfus = 4;
  float voxel_size = 1;
  Finishing finishing = {};
  std::optional<SamplingHardware> sampling = {};  // of rays that are sampled
};

void sample(const SamplingHardware& hw, tb::PaperVsuPlan& plan) {
  PaperVsuConfig& config = plan.config;
  config.samples_per_cycle = hw.samples;
  config.sample_step_voxels = static_cast<double>(hw.step_voxels);
  config.sample_far_voxels = static_cast<double>(hw.far_voxels);
  config.rays_in_flight = hw.rays;
  config.ray_step_px = hw.ray_step_px;
  config.ray_lanes = hw.begin_lanes;
  config.ray_depth_cycles = hw.begin_cycles;
  config.step_depth_cycles = hw.sample_cycles;
  config.renaming_bytes = hw.renaming_bytes;
  config.adjacency_lines = hw.lines;
  config.adjacency_destinations = hw.destinations;
  SampledRays::place_tables(config, plan.scene.grid, plan.scene.job);
}

tb::PaperVsuPlan plan_of(const PaperVsuWorkload& load, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  tb::SceneShape shape;
  shape.gaussians = load.gaussians;
  shape.voxel_size = load.voxel_size;
  shape.group = preset_of<PaperConfig>("paper").group;
  // A whole row of a group's pixels and one that the frame's edge cuts, lower than groups are.
  shape.width_px = 3 * shape.group.width / 2;
  shape.height_px = shape.group.height / 2;
  tb::PaperVsuPlan plan = tb::paper_vsu_plan_of(tb::random_scene(random, shape));
  const PaperVsuHardware& hw = load.hardware;
  const auto lanes = [](std::uint64_t macs, std::uint32_t turn) {
    return static_cast<std::uint32_t>(tb::ceil_div(macs, turn));
  };
  PaperVsuConfig& config = plan.config;
  config.rays_in_flight = hw.rays.rays;
  config.chain_entries = hw.rays.chain_entries;
  config.ray_step_px = hw.rays.ray_step_px;
  config.step_lanes = lanes(tb::macs_of_a_step(), hw.rays.step_turn);
  config.ray_lanes = lanes(tb::macs_of_a_beginning(), hw.rays.begin_turn);
  config.step_depth_cycles = hw.rays.block_cycles;
  config.cell_step_depth_cycles = hw.rays.cell_cycles;
  config.ray_depth_cycles = hw.rays.begin_cycles;
  config.node_cache_bytes = hw.rays.node_cache_bytes;
  config.node_fetches = hw.rays.node_fetches;
  config.table_bytes = hw.table_bytes;
  config.table_banks = hw.table_banks;
  config.groups_ahead = hw.lists;
  config.record_cache_bytes = hw.record_cache_bytes;
  config.cut_cache_bytes = hw.cut_cache_bytes;
  config.visit_gaussians = hw.visit_gaussians;
  config.min_share = hw.min_share;
  if (load.sampling) sample(*load.sampling, plan);
  return plan;
}

std::uint64_t what_of_share(const VisitShare& share) {
  return share.mark == Mark::kEndOfGroup ? kEndOfGroup : test::what_of(share.first, share.count);
}

Pace pace_of(const PaperVsuWorkload& load, std::uint64_t seed, std::uint32_t hfu) {
  return {seed + 1000 + hfu, load.out_one_in, load.out_longest};
}

// Of one HFU behind the other.
Takings joined(const std::vector<Takings>& of_hfus) {
  Takings all;
  for (const Takings& taken : of_hfus) all.insert(all.end(), taken.begin(), taken.end());
  return all;
}

void run_paper_vsu(tb::Case& test, Takings& taken, const PaperVsuWorkload& load,
                   std::uint64_t seed) {
  const tb::PaperVsuPlan plan = plan_of(load, seed);
  const StreamingJob& job = plan.scene.job;
  tb::UnitBench bench(test, bench_of(load.hardware.rays.port, tb::memory_bytes(job)));
  bench.load(0, plan.scene.image.bytes);
  if (load.sampling) bench.load(job.renaming.records.base, *job.renaming.contents);
  FinishedGroups finished("finished", bench.clock(), job.groups.size(), 1);
  const auto shares = bench.add_fifos<VisitShare>("to_hfu", load.hfus, load.entries, 1);
  PaperVsu unit("vsu", plan.config, bench.context(job));
  for (TimedFifo<VisitShare>* fifo : shares) unit.shares(*fifo);
  unit.finished(finished);
  bench.add_unit(unit);
  std::vector<Takings> of_hfus(load.hfus);
  for (std::uint32_t h = 0; h < load.hfus; ++h) {
    bench.add_thread(fmt::format("hfu{}", h), [&, h](Activity& activity) {
      const Pace pace = pace_of(load, seed, h);
      for (std::size_t ends = 0; ends < job.groups.size();) {
        bench.clock().wait_cycles(pace.gap(of_hfus[h].size()));
        const std::uint64_t what = what_of_share(shares[h]->pop(activity));
        of_hfus[h].push_back({bench.clock().now_cycles(), what});
        ends += what == kEndOfGroup ? 1 : 0;
      }
    });
  }
  add_finishing(bench, load.finishing, job.groups.size(), finished);
  bench.run();
  taken = joined(of_hfus);
}

template <class Rays, class Table>
Takings clocked_paper_vsu(const PaperVsuWorkload& load, std::uint64_t seed,
                          const tb::PaperVsuPlan& plan, const Rays& rays, const Table& table) {
  const StreamingJob& job = plan.scene.job;
  PaperVsuHardware hardware = load.hardware;
  hardware.numbers = hardware_of(GroupUse::kRays);
  ClockedPaperVsu<Rays, Table> unit(hardware, job.view, plan.scene.grid, job.layout.voxel_table(),
                                    job.groups, rays, table);
  std::vector<ClockedFifo<std::uint64_t>> shares(load.hfus,
                                                 ClockedFifo<std::uint64_t>(load.entries));
  std::vector<ClockedSink<std::uint64_t>> sinks;
  for (std::uint32_t h = 0; h < load.hfus; ++h) sinks.emplace_back(pace_of(load, seed, h));
  std::size_t ends = 0;
  for (std::uint64_t now = 0; ends < load.hfus * job.groups.size(); ++now) {
    for (std::uint32_t h = 0; h < load.hfus; ++h) {
      sinks[h].step(shares[h], now, [&](std::uint64_t what) {
        ends += what == kEndOfGroup ? 1 : 0;
        return what;
      });
    }
    unit.step(shares, [&](std::uint32_t group) { return load.finishing.seen(group, now); });
    for (ClockedFifo<std::uint64_t>& fifo : shares) fifo.step();
  }
  std::vector<Takings> of_hfus;
  for (const ClockedSink<std::uint64_t>& sink : sinks) of_hfus.push_back(sink.taken());
  return joined(of_hfus);
}

Takings clocked_paper_vsu(const PaperVsuWorkload& load, std::uint64_t seed) {
  const tb::PaperVsuPlan plan = plan_of(load, seed);
  const StreamingJob& job = plan.scene.job;
  const VoxelGrid& grid = plan.scene.grid;
  const PaperVsuHardware& hw = load.hardware;
  if (load.sampling) {
    return clocked_paper_vsu(
        load, seed, plan,
        ClockedSampling(*load.sampling, job.view, grid, job.renaming.records.base),
        ClockedSampledTable(*load.sampling, hw.rays.port, grid.voxels.size(), hw.table_bytes));
  }
  return clocked_paper_vsu(
      load, seed, plan, ClockedRays(hw.rays, job.view, grid, job.layout.voxel_table().nodes),
      ClockedOrderingTable(grid.voxels.size(), hw.table_bytes, hw.table_banks));
}

TEST_CASE("clocked reference: VSU of paper order") {
  Comparison table("VSU, paper order");
  PaperVsuHardware paper;
  paper.rays.port = {preset_of<PaperConfig>("paper").port, 20};
  PaperVsuHardware far = paper;
  far.rays.port.read_latency = 300;
  PaperVsuHardware tiny = paper;
  tiny.rays.rays = 4;
  tiny.rays.compare_cycles = 1;
  tiny.rays.chain_entries = 1;
  tiny.rays.node_cache_bytes = tiny.record_cache_bytes = tiny.cut_cache_bytes = 128;
  PaperVsuHardware narrow = paper;
  narrow.rays.step_turn = 3;
  narrow.rays.begin_turn = 16;
  narrow.table_banks = 1;
  PaperVsuHardware wide = paper;
  wide.rays.begin_turn = 1;
  wide.rays.ray_step_px = 1;
  wide.lists = 2;
  PaperVsuHardware cut = paper;
  cut.visit_gaussians = 64;
  cut.min_share = 2;
  PaperVsuHardware places = paper;
  places.rays.port.read_latency = 100;
  places.rays.node_fetches = 2;
  places.rays.node_cache_bytes = 512;
  PaperVsuHardware full = paper;
  full.table_bytes = 400;
  PaperVsuHardware full_and_far = full;
  full_and_far.rays.node_cache_bytes = 128;
  full_and_far.rays.port.read_latency = 100;
  full_and_far.rays.node_fetches = 3;
  for (const PaperVsuWorkload& load : {
           PaperVsuWorkload{"light: 100 Gaussians", 100, 1, 1, paper},
           PaperVsuWorkload{"heavy: 3000 Gaussians", 3000, 1, 1, paper},
           PaperVsuWorkload{"output stalled", 1500, 4, 300, paper},
           PaperVsuWorkload{"memory of 300 cycles, small voxels", 3000, 1, 1, far, 4, 4, 0.2F},
           PaperVsuWorkload{"two lines on their way", 3000, 1, 1, places, 4, 4, 0.2F},
           PaperVsuWorkload{"tiny buffers", 1500, 1, 1, tiny, 1, 1, 0.5F},
           PaperVsuWorkload{"a step in 3, a ray in 16, a bank", 1500, 1, 1, narrow},
           PaperVsuWorkload{"a ray a cycle, of every pixel", 1500, 1, 1, wide},
           PaperVsuWorkload{"voxels cut", 5000, 1, 1, cut, 4, 4, 2},
           PaperVsuWorkload{"passes: a table of 400 B", 1500, 1, 1, full},
           PaperVsuWorkload{"passes, small voxels", 4000, 1, 1, full_and_far, 4, 4, 0.3F},
           PaperVsuWorkload{"groups that finish", 1500, 4, 300, paper, 4, 4, 1, {21000}},
       }) {
    table.workload(load, run_paper_vsu, [](const PaperVsuWorkload& of, std::uint64_t seed) {
      return clocked_paper_vsu(of, seed);
    });
  }
}

TEST_CASE("clocked reference: VSU of paper order that samples rays") {
  Comparison table("VSU that samples, paper order");
  PaperVsuHardware paper;
  paper.rays.port = {preset_of<PaperConfig>("paper").port, 20};
  PaperVsuHardware far = paper;
  far.rays.port.read_latency = 100;
  PaperVsuHardware full = far;
  full.table_bytes = 400;
  PaperVsuHardware little = paper;
  little.table_bytes = 128;
  PaperVsuHardware cut = paper;
  cut.visit_gaussians = 64;
  SamplingHardware one;
  one.begin_macs = static_cast<std::uint32_t>(tb::macs_of_a_sampled_beginning());
  SamplingHardware four = one;
  four.samples = 4;
  four.begin_lanes = 32;
  SamplingHardware few = one;
  few.rays = 1;
  few.begin_lanes = 4;
  few.ray_step_px = 4;
  few.far_voxels = 6;
  SamplingHardware small = one;
  small.samples = 2;
  small.renaming_bytes = 256;
  SamplingHardware narrow = small;
  narrow.lines = 16;
  narrow.destinations = 2;
  for (const PaperVsuWorkload& load : {
           PaperVsuWorkload{"light: 100 Gaussians", 100, 1, 1, paper, 4, 4, 1, {}, one},
           PaperVsuWorkload{"heavy: 3000 Gaussians", 3000, 1, 1, paper, 4, 4, 1, {}, one},
           PaperVsuWorkload{"four samples a cycle", 3000, 1, 1, paper, 4, 4, 0.3F, {}, four},
           PaperVsuWorkload{"a ray at a time, 6 voxels long", 1500, 1, 1, paper, 4, 4, 1, {}, few},
           PaperVsuWorkload{"output stalled", 1500, 4, 300, paper, 4, 4, 1, {}, one},
           PaperVsuWorkload{"names in DRAM", 3000, 1, 1, far, 4, 4, 0.3F, {}, small},
           PaperVsuWorkload{"edges in DRAM", 3000, 1, 1, far, 4, 4, 0.3F, {}, narrow},
           PaperVsuWorkload{"voxels cut", 5000, 1, 1, cut, 4, 4, 2, {}, one},
           PaperVsuWorkload{"passes: a table of 400 B", 3000, 1, 1, full, 4, 4, 0.5F, {}, small},
           PaperVsuWorkload{"passes: tags are freed", 3000, 1, 1, little, 4, 4, 1, {}, four},
           PaperVsuWorkload{"groups that finish", 1500, 4, 300, paper, 4, 4, 1, {21000}, one},
       }) {
    table.workload(load, run_paper_vsu, [](const PaperVsuWorkload& of, std::uint64_t seed) {
      return clocked_paper_vsu(of, seed);
    });
  }
}

}  // namespace
}  // namespace sgs::test
