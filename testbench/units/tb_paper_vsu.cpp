// Voxel sorting unit in paper order, alone: the voxel table in memory, visits out to several HFUs.
// Checked against paper_visits on the grid itself; times from below, by what rays share. To the
// cycle: tests/modules/streaminggs/clocked.
#include <algorithm>

#include "modules/datapath/group_numbers.h"
#include "modules/streaminggs/vsu/paper_vsu.h"
#include "testbench/units/case_runner.h"
#include "testbench/units/job_memory.h"
#include "testbench/units/paper_vsu_plan.h"
#include "testbench/units/reported_groups.h"
#include "testbench/units/unit_bench.h"

namespace sgs::tb {
namespace {

// All shares of one visit or of one end-of-group mark, put together.
struct Received {
  std::vector<VisitShare> shares;  // [HFU]
  std::uint64_t cycle = 0;         // in which the last share came
};

void check_visit(Checks& checks, const PaperVsuPlan& plan, std::uint32_t number,
                 const Received& got, std::uint32_t group, const VoxelRecord& record) {
  std::uint32_t sum = 0, at = record.first;
  for (std::uint32_t k = 0; k < plan.hfus; ++k) {
    const VisitShare& share = got.shares[(k + number) % plan.hfus];
    checks.equal(share.visit, number, "number of a visit");
    checks.equal(share.group, group, fmt::format("visit {}: group", number));
    checks.that(share.mark == Mark::kEndOfVisit, fmt::format("visit {}: mark", number));
    if (share.count > 0) {
      checks.equal(share.first, at, fmt::format("visit {}: begin of share {}", number, k));
      const bool last = sum + share.count == record.count;
      checks.that(last || share.count >= plan.config.min_share,
                  fmt::format("visit {}: share {} of {} is too small", number, k, share.count));
    }
    at += share.count;
    sum += share.count;
  }
  checks.equal(sum, record.count, fmt::format("visit {}: Gaussians", number));
}

// Every group's visits in the expected order (of a finished group, the first of them), then its
// end.
void check_stream(UnitBench& bench, const PaperVsuPlan& plan, const ExpectedVisits& expected,
                  const std::vector<Received>& received, const ReportedGroups& finished) {
  Checks& checks = bench.checks();
  std::uint32_t number = 0;
  std::uint64_t left_out = 0;
  for (std::uint32_t group = 0; group < expected.groups.size(); ++group) {
    const std::vector<VoxelRecord>& pieces = expected.groups[group];
    std::size_t visit = 0;
    std::vector<std::uint64_t> cycles;
    for (; number < received.size(); ++number, ++visit) {
      const Received& got = received[number];
      if (got.shares[0].mark == Mark::kEndOfGroup) break;
      checks.that(visit < pieces.size(), fmt::format("group {}: too many visits", group));
      if (visit < pieces.size()) check_visit(checks, plan, number, got, group, pieces[visit]);
      cycles.push_back(got.cycle);
    }
    // Between passes of a group it waits, and may see only then that the group is finished.
    const std::size_t all = expected.overflows > 0 ? cycles.size() : pieces.size();
    if (bench.without_stalls()) check_feedback(checks, finished, group, cycles, all);
    if (!finished.finished(group)) {
      checks.equal(visit, pieces.size(), fmt::format("group {}: visits", group));
    }
    left_out += pieces.size() - std::min(visit, pieces.size());
    checks.that(number < received.size(), fmt::format("group {}: no end", group));
    if (number == received.size()) return;
    for (const VisitShare& end : received[number].shares) {
      checks.that(end.mark == Mark::kEndOfGroup && end.group == group && end.visit == number &&
                      end.count == 0,
                  fmt::format("group {}: end", group));
    }
    ++number;
  }
  checks.equal(number, received.size(), "visits and ends");
  // Left out are voxels, which nobody has cut.
  if (plan.config.visit_gaussians == 0) bench.check_counter("visits_saturated", left_out);
  if (left_out == 0) bench.check_counter("cuts", expected.cuts);
  checks.equal(bench.counter("visits") + left_out, expected.visits, "visits accounted for");
}

// Memories of the caches and of the ordering table, which are cleared after each group, and what is
// compared: what is read of the table with the voxel; a voxel that is met with the two ends of the
// window, and with the two ends of what is in it when it is entered; rounds, and lines that have
// come, with those of all contexts; a miss with the lines on their way; a look-up with the tags of
// a set. handed: contexts that went from ray to ray; again: look-ups for which there was no place
// before.
void check_tables(UnitBench& bench, const PaperVsuPlan& plan, const ExpectedVisits& expected,
                  std::uint64_t handed, std::uint64_t again, std::uint64_t missed,
                  std::uint64_t node_misses) {
  constexpr std::uint64_t kWays = 4, kNamesAtOnce = 4;
  const OrderingAccesses& table = expected.table;
  const std::uint64_t clearing =
      Renaming::slots_for(OrderingTable::most_voxels(plan.config.table_bytes)) / kNamesAtOnce;
  bench.check_accesses("ordering table", table.reads, table.writes);
  bench.check_accesses("renamed voxels", table.names_read,
                       table.names_written + expected.orderings * clearing);
  bench.check_accesses("ready voxels", table.ready_read, table.ready_written);
  // A word of 32 B holds what is looked up, and a line.
  bench.check_accesses("node cache", expected.lookups + again, node_misses);
  const std::uint64_t contexts = plan.config.rays_in_flight;
  const std::uint64_t ordered = bench.counter("voxels") + bench.counter("cuts");
  bench.check_operations("vsu", "comparator",
                         table.reads + 2 * expected.met + 2 * expected.met +
                             (expected.met + handed + node_misses + again) * contexts +
                             missed * plan.config.node_fetches +
                             kWays * (expected.lookups + again + ordered) + bench.counter("cuts"));
}

// Its cycles are never fewer than each thing that the rays share takes.
void check_traversal(UnitBench& bench, const PaperVsuPlan& plan, const ExpectedVisits& expected,
                     std::uint64_t node_misses) {
  Checks& checks = bench.checks();
  const std::uint64_t busy = bench.busy_cycles("vsu");
  if (expected.overflows == 0) {
    const std::uint64_t rays = expected.rays, steps = expected.steps - rays;
    checks.that(busy >= expected.lookups, "more than a look-up a cycle");
    checks.that(busy * plan.config.step_lanes >= steps * macs_of_a_step(), "too many steps");
    checks.that(busy * plan.config.ray_lanes >= rays * macs_of_a_beginning(), "too many rays");
    checks.that(busy >= expected.met, "more than a voxel entered a cycle");
    const std::uint64_t of_a_step =
        std::min(plan.config.step_depth_cycles, plan.config.cell_step_depth_cycles);
    checks.that(busy * plan.config.rays_in_flight >=
                    steps * of_a_step + rays * plan.config.ray_depth_cycles,
                "more rays side by side than there are contexts");
    bench.check_accesses("ray chains", expected.met, expected.met);
    bench.check_accesses("ray directions", steps, rays);
    // A node that is looked up is put on its ray's stack; the step behind it reads where it stands.
    bench.check_accesses("ray nodes", steps, expected.lookups);
    // A ray's beginning leaves its place there; a step and a look-up read it and leave the next.
    const std::uint64_t again = bench.accesses("node cache").first - expected.lookups;
    const std::uint64_t missed =
        bench.accesses("tags of node fetches").first / plan.config.node_fetches;
    checks.that(missed >= node_misses + again, "look-ups that missed");
    bench.check_accesses("ray positions", steps + expected.lookups + again,
                         rays + steps + expected.lookups);
    // The round of a ray changes as it begins, steps, and enters what it met. The first of all is
    // found for each voxel that is entered, and for each ray that is begun in another's context.
    const std::uint64_t contexts = plan.config.rays_in_flight;
    std::uint64_t handed = 0;
    for (const std::uint64_t of_group : expected.rays_of) {
      handed += of_group - std::min(of_group, contexts);
    }
    bench.check_accesses("rounds of rays", (expected.met + handed) * contexts,
                         rays + steps + expected.met);
    // A look-up that misses is looked for among the lines on their way, and its ray waits. Who
    // waits is looked for as a line comes, and as a place is free. A word of 32 B holds a line.
    bench.check_accesses("tags of node fetches", missed * plan.config.node_fetches, node_misses);
    bench.check_accesses("node fetches", node_misses, node_misses);
    bench.check_accesses("rays that wait for nodes", (node_misses + again) * contexts, missed);
    checks.that(again == 0 || plan.config.node_fetches < contexts, "a ray without its own place");
    bench.check_accesses("node cache tags", expected.lookups + again, expected.lookups + again);
    check_tables(bench, plan, expected, handed, again, missed, node_misses);
  }
}

void check_rays(UnitBench& bench, const PaperVsuPlan& plan, const ExpectedVisits& expected) {
  Checks& checks = bench.checks();
  // Where the table overflows, rays behind the one that did not fit have begun as well.
  const std::uint64_t rays = bench.counter("rays"), steps = bench.counter("steps");
  checks.that(rays >= expected.rays &&
                  rays <= expected.rays + expected.overflows * (plan.config.rays_in_flight - 1),
              "rays");
  checks.that(expected.overflows > 0 ? steps >= expected.steps : steps == expected.steps, "steps");
  bench.check_operations("vsu", "fp32_lane",
                         (steps - rays) * macs_of_a_step() + rays * macs_of_a_beginning());
  bench.check_operations(
      "vsu", "number_comparator",
      (steps - rays) * comparisons_of_a_step() + rays * comparisons_of_a_beginning() +
          plan.scene.job.groups.size() * group_flow(GroupUse::kRays).counts().comparisons);
}

// Samples: of rays that lie in no window, since what they meet first is behind it, none are looked
// at. Without passes all are, each with its lanes; a cell is looked up once a ray.
void check_samples(UnitBench& bench, const PaperVsuPlan& plan, const ExpectedVisits& expected) {
  Checks& checks = bench.checks();
  const std::uint64_t rays = bench.counter("rays"), samples = bench.counter("samples");
  checks.equal(rays, expected.rays, "rays");
  // Samples take neither quotients nor roots.
  bench.check_operations("vsu", "fp32_chaining_lane", samples * macs_of_a_sample());
  bench.check_operations("vsu", "fp32_lane", rays * macs_of_a_sampled_beginning());
  checks.that(bench.counter("cells_looked_up") <= samples, "cells without a sample");
  if (expected.overflows > 0) return;
  checks.equal(bench.counter("steps"), expected.steps, "steps");
  checks.that(samples <= expected.steps, "samples");
  const std::uint64_t busy = bench.busy_cycles("vsu");
  checks.that(busy * plan.config.samples_per_cycle >= samples, "more samples a cycle");
  checks.that(busy >= bench.counter("cells_looked_up"), "more than a look-up a cycle");
  checks.that(busy >= expected.met, "more than a voxel entered a cycle");
  // Rays begin while a table waits for memory, too.
  const bool all_on_chip =
      bench.counter("renaming_misses") + bench.counter("adjacency_lines_back") == 0;
  checks.that(!all_on_chip || busy * plan.config.ray_lanes >= rays * macs_of_a_sampled_beginning(),
              "too many rays");
  const std::uint64_t clearing =
      Renaming::slots_for(OrderingTable::most_voxels(plan.config.table_bytes)) / 4;
  const OrderingAccesses& table = expected.table;
  bench.check_accesses("ordering table", table.reads, table.writes);
  bench.check_accesses("renamed voxels", table.names_read,
                       table.names_written + expected.orderings * clearing);
  bench.check_accesses("ready voxels", table.ready_read, table.ready_written);
}

// A line a miss.
void check_tree_traffic(UnitBench& bench, const PaperVsuPlan& plan, std::uint64_t node_misses,
                        std::uint64_t record_misses) {
  Checks& checks = bench.checks();
  checks.equal(bench.counter("node_cache_misses"), node_misses, "misses of the tree's cache");
  checks.that(bench.bytes_read() <= kLineBytes * (node_misses + record_misses),
              "bytes read: more than a line a miss");
  // A cache that holds all of the tree fetches each of its lines once.
  const std::uint64_t tree_bytes = plan.scene.grid.nodes.size() * sizeof(VoxelNode);
  if (tree_bytes <= plan.config.node_cache_bytes) {
    checks.that(node_misses <= ceil_div(tree_bytes, kLineBytes), "lines of the tree fetched again");
  }
}

// A line of names a miss, and lines of edges out and back.
void check_table_traffic(UnitBench& bench, const PaperVsuPlan& plan, std::uint64_t transactions) {
  Checks& checks = bench.checks();
  const std::uint64_t misses = bench.counter("renaming_misses");
  const std::uint64_t out = bench.counter("adjacency_lines_out");
  checks.equal(misses + out + bench.counter("adjacency_lines_back"), transactions,
               "lines of both tables");
  checks.equal(bench.bytes_written(), out * 2 * plan.config.adjacency_destinations,
               "bytes of edges written");
  const std::uint64_t table_bytes = plan.scene.job.renaming.records.bytes();
  if (table_bytes <= plan.config.renaming_bytes) {
    checks.that(misses <= ceil_div(table_bytes, kLineBytes), "lines of names fetched again");
  }
}

void run_plan(Case& test, const BenchConfig& bench_config, const PaperVsuPlan& plan) {
  const ExpectedVisits expected = expect(plan);
  UnitBench bench(test, bench_config);
  Checks& checks = bench.checks();
  bench.load(0, plan.scene.image.bytes);
  if (const auto& table = plan.scene.job.renaming.contents) {
    bench.load(plan.scene.job.renaming.records.base, *table);
  }
  ReportedGroups finished(bench.clock(), plan.scene.job.groups.size(), plan.feedback_cycles);
  for (std::uint32_t g = 0; plan.finished_before && g < plan.scene.job.groups.size(); ++g) {
    finished.finish(g);
  }
  const auto shares = bench.add_fifos<VisitShare>("to_hfu", plan.hfus, plan.fifo_entries, 1);
  PaperVsu unit("vsu", plan.config, bench.context(plan.scene.job));
  for (TimedFifo<VisitShare>* fifo : shares) unit.shares(*fifo);
  unit.finished(finished.channel);
  bench.add_unit(unit);

  std::vector<Received> received;
  for (std::uint32_t h = 0; h < plan.hfus; ++h) {
    bench.add_thread(fmt::format("hfu{}", h), [&, h](Activity& activity) {
      std::size_t at = 0;
      for (std::size_t ends = 0; ends < plan.scene.job.groups.size(); ++at) {
        const VisitShare share = shares[h]->pop(activity);
        if (at == received.size()) received.push_back({std::vector<VisitShare>(plan.hfus), 0});
        received[at].shares[h] = share;
        received[at].cycle = bench.clock().now_cycles();
        ends += share.mark == Mark::kEndOfGroup ? 1 : 0;
        if (plan.saturate_one_in > 0 &&
            test.random() % static_cast<unsigned>(plan.saturate_one_in) == 0) {
          finished.finish(share.group);
        }
      }
    });
  }
  bench.run();
  check_stream(bench, plan, expected, received, finished);

  const std::uint64_t visits = bench.counter("visits");
  if (plan.finished_before) checks.equal(visits, 0U, "visits of finished groups");
  bench.check_counter("edges", expected.edges);
  plan.config.samples() ? check_samples(bench, plan, expected) : check_rays(bench, plan, expected);
  // Each voxel is opened, and two pieces for a cut; what is left of a finished group's is dropped.
  const std::uint64_t pieces = bench.counter("voxels") + 2 * bench.counter("cuts");
  bench.check_accesses("open pieces", visits + bench.counter("cuts"), pieces);
  if (visits == expected.visits) {
    checks.equal(pieces, visits + bench.counter("cuts"), "pieces opened and taken");
  }
  // Each is read once, to be visited or left out.
  bench.check_accesses("ordered voxels", expected.voxels - bench.counter("visits_saturated"),
                       expected.voxels);
  // A voxel's record is looked up as it is visited, a plane as it is cut.
  bench.check_accesses("record cache tags", bench.counter("voxels"), bench.counter("voxels"));
  bench.check_accesses("cut cache tags", bench.counter("cuts"), bench.counter("cuts"));
  bench.check_accesses("record cache", bench.counter("voxels"),
                       bench.counter("record_cache_misses"));
  bench.check_accesses("cut cache", bench.counter("cuts"), bench.counter("cut_cache_misses"));
  bench.check_counter("groups_empty", expected.empty);
  bench.check_counter("ordering_table_bytes_max", expected.table_bytes_max);
  checks.that(expected.table_bytes_max <= plan.config.table_bytes, "ordering table over its bytes");
  bench.check_counter("passes", expected.passes);
  bench.check_counter("overflows", expected.overflows);
  checks.equal(expected.overflows > 0, expected.passes > plan.scene.job.groups.size(),
               "a table that overflows is ordered in passes");
  checks.equal(bench.busy_cycles("visits"), visits + bench.counter("cuts") + expected.groups.size(),
               "busy cycles of handing out");
  const std::uint64_t record_misses = unit.record_memory.transactions();
  checks.equal(bench.counter("record_cache_misses") + bench.counter("cut_cache_misses"),
               record_misses, "misses of the voxels' caches");
  if (plan.config.samples()) {
    check_table_traffic(bench, plan, unit.node_memory.transactions());
  } else {
    check_traversal(bench, plan, expected, unit.node_memory.transactions());
    check_tree_traffic(bench, plan, unit.node_memory.transactions(), record_misses);
  }
}

void sample_rays(std::mt19937_64& random, PaperVsuPlan& plan) {
  PaperVsuConfig& config = plan.config;
  config.samples_per_cycle = 1 + static_cast<std::uint32_t>(random() % 5);
  config.sample_step_voxels = random() % 2 == 0 ? 0.5 : 1.3;
  config.sample_far_voxels = random() % 3 == 0 ? static_cast<double>(random() % 40) : 0;
  const auto of_ray =
      static_cast<std::uint32_t>(ceil_div(macs_of_a_sampled_beginning(), config.ray_lanes));
  config.ray_depth_cycles = of_ray + static_cast<std::uint32_t>(random() % 100);
  config.renaming = random() % 2 == 0 ? RenamingForm::kHashed : RenamingForm::kDense;
  config.renaming_bytes = 128U << (random() % 6);
  config.adjacency_lines = 1 + static_cast<std::uint32_t>(random() % 80);
  config.adjacency_destinations = 1 + static_cast<std::uint32_t>(random() % 9);
  SampledRays::place_tables(config, plan.scene.grid, plan.scene.job);
}

void random_case(Case& test) {
  std::mt19937_64& random = test.random;
  PaperVsuPlan plan = paper_vsu_plan_of(random_scene(random, random_shape(random)));
  plan.hfus = 1 + static_cast<std::uint32_t>(random() % 6);
  plan.fifo_entries = 1 + static_cast<std::uint32_t>(random() % 6);
  plan.config.step_lanes = 1 + static_cast<std::uint32_t>(random() % 200);
  plan.config.rays_in_flight = 1 + static_cast<std::uint32_t>(random() % 40);
  plan.config.chain_entries = 1 + static_cast<std::uint32_t>(random() % 20);
  plan.config.ray_lanes = 1 + static_cast<std::uint32_t>(random() % 70);
  // No result is there before its lanes are free.
  const auto of_step =
      static_cast<std::uint32_t>(ceil_div(macs_of_a_step(), plan.config.step_lanes));
  const auto of_ray =
      static_cast<std::uint32_t>(ceil_div(macs_of_a_beginning(), plan.config.ray_lanes));
  plan.config.step_depth_cycles = of_step + static_cast<std::uint32_t>(random() % 60);
  plan.config.cell_step_depth_cycles = of_step + static_cast<std::uint32_t>(random() % 20);
  plan.config.ray_depth_cycles = of_ray + static_cast<std::uint32_t>(random() % 100);
  plan.config.table_banks = 1 + static_cast<std::uint32_t>(random() % 2);
  plan.config.groups_ahead = 1 + static_cast<std::uint32_t>(random() % 3);
  plan.config.node_cache_bytes = 256U << (random() % 5);
  plan.config.node_fetches = 1 + static_cast<std::uint32_t>(random() % 12);
  plan.config.record_cache_bytes = 256U << (random() % 3);
  plan.config.min_share = 2 + static_cast<std::uint32_t>(random() % 40);
  plan.config.sample_step_voxels = random() % 4 == 0 ? 0.5 : 0;
  plan.config.ray_step_px = 1 + static_cast<std::uint32_t>(random() % 9);
  if (random() % 2 == 0) plan.config.table_bytes = 8 + static_cast<std::uint32_t>(random() % 400);
  plan.config.visit_gaussians =
      random() % 2 == 0 ? 0 : 1 + static_cast<std::uint32_t>(random() % 300);
  if (random() % 3 == 0) sample_rays(random, plan);
  plan.saturate_one_in = random() % 3 == 0 ? 5 : 0;
  plan.feedback_cycles = 1 + static_cast<std::uint32_t>(random() % 40);
  run_plan(test, random_bench(random, memory_bytes(plan.scene.job)), plan);
}

}  // namespace
}  // namespace sgs::tb

int sc_main(int argc, char* argv[]) {
  using namespace sgs;
  using namespace sgs::tb;
  CaseRunner runner("tb_paper_vsu",
                    "Voxel sorting unit in paper order, against the order of each group's rays");
  const auto add = [&](const std::string& name, auto shape, auto change) {
    runner.add_directed(name, [=](Case& test) {
      SceneShape own;
      shape(own);
      PaperVsuPlan plan = paper_vsu_plan_of(random_scene(test.random, own));
      change(plan);
      run_plan(test, still_bench(memory_bytes(plan.scene.job)), plan);
    });
  };
  const auto same = [](SceneShape&) {};
  const auto usual = [](PaperVsuPlan&) {};
  add("several groups", same, usual);
  add(
      "empty scene", [](SceneShape& shape) { shape.gaussians = 0; }, usual);
  add(
      "one Gaussian", [](SceneShape& shape) { shape.gaussians = 1; }, usual);
  const auto crowded = [](SceneShape& shape) { shape.voxel_size = 100; };
  add("voxels that hold an eighth of all", crowded, usual);
  const auto many = [=](SceneShape& shape) {
    crowded(shape);
    shape.gaussians = 5000;
  };
  for (const std::uint32_t most : {1U, 64U, 100U, 1000U}) {
    add(fmt::format("voxels cut into pieces of {}", most), many,
        [=](PaperVsuPlan& plan) { plan.config.visit_gaussians = most; });
  }
  const auto fine = [](SceneShape& shape) { shape.voxel_size = 0.001F; };
  add("a voxel for each Gaussian", fine, usual);
  for (const RenamingForm form : {RenamingForm::kHashed, RenamingForm::kDense}) {
    const char* name = form == RenamingForm::kDense ? "dense" : "hashed";
    add(fmt::format("sampled rays, {} renaming table", name), same, [=](PaperVsuPlan& plan) {
      plan.config.samples_per_cycle = 2;
      plan.config.sample_step_voxels = 0.5;
      plan.config.renaming = form;
      SampledRays::place_tables(plan.config, plan.scene.grid, plan.scene.job);
    });
  }
  add(
      "1x1 frame", [](SceneShape& shape) { shape.width_px = shape.height_px = 1; }, usual);
  const auto whole = [](SceneShape& shape) { shape.group = square_of(64); };
  add("group larger than the frame", whole, usual);
  add("a group that is finished at once", whole, [](PaperVsuPlan& plan) {
    plan.saturate_one_in = 1;
    plan.fifo_entries = 1;
  });
  add("groups finished before they begin", same,
      [](PaperVsuPlan& plan) { plan.finished_before = true; });
  // 8 bytes are a voxel a pass.
  for (const std::uint32_t bytes : {8U, 12U, 20U, 64U, 300U}) {
    add(fmt::format("ordering table of {} bytes", bytes), same,
        [=](PaperVsuPlan& plan) { plan.config.table_bytes = bytes; });
  }
  runner.set_random(random_case);
  return runner.run(argc, argv);
}
