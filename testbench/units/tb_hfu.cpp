// Hierarchical filtering unit alone: shares of visits in, splats out to several sorting units.
// Checked against the coarse bound and make_splat on what the bytes in memory decode to; times of
// the coarse filter alone are written out. All others: tests/modules/streaminggs/clocked.
#include "algorithm/splat/gaussian.h"
#include "algorithm/storage/encoded_cloud.h"
#include "testbench/units/hfu_run.h"
#include "testbench/units/job_memory.h"

namespace sgs::tb {
namespace {

// n Gaussians behind the camera: none passes, so the mark is there after the time of the coarse
// filter alone, written out here: FIFO 1, start of the read 1, memory, turns of the CFUs in the
// first 4 of each 14 cycles, depth of the CFU, two FIFOs.
void exact_coarse_time(Case& test, std::uint32_t n) {
  SceneShape shape;
  HfuPlan plan = hfu_plan_of(random_scene(test.random, shape));
  for (Gaussian<float>& g : plan.scene.cloud.gaussians) {
    const auto& view = plan.scene.job.view;
    for (int axis = 0; axis < 3; ++axis) {
      g.mean[axis] = view.position[axis] - 2 * view.cam_from_world[2][axis];
    }
  }
  auto [grid, order] = arrange_by_voxels(plan.scene.cloud, shape.voxel_size);
  plan.scene.grid = std::move(grid);
  plan.scene.cloud = reordered(plan.scene.cloud, order);
  plan.scene.image = build_memory_image(encode_raw(plan.scene.cloud), plan.scene.grid);
  place(plan.scene.image.layout, 0, plan.scene.job);
  constexpr std::uint64_t kMarkCycles = 3;  // coarse filter, fetch, FFU: one each
  constexpr std::uint64_t kLatency = 37, kInterval = 14, kDepth = 12;  // ceil(55 / 4)
  BenchConfig config = still_bench(memory_bytes(plan.scene.job));
  config.latency_cycles = kLatency;
  UnitBench bench(test, config);
  bench.load(0, plan.scene.image.bytes);
  FinishedGroups finished("finished", bench.clock(), plan.scene.job.groups.size(), 1);
  auto& input = bench.add_fifo<VisitShare>("shares", 4, 1);
  auto& output = bench.add_fifo<SplatToken>("to_sorting0", 4, 1);
  const std::unique_ptr<Hfu> unit = bound_hfu(bench, plan, finished, input, {&output}, nullptr);
  bench.add_thread("vsu", [&](Activity& activity) {
    input.push({0, 0, 0, n, Mark::kEndOfVisit}, activity);
  });
  bench.add_thread("sorting0", [&](Activity& activity) {
    // The last transaction of the slice leaves so many cycles after the first.
    const std::uint64_t leaving =
        (kFirstHalfBytes * n - 1) / MemoryPortConfig{}.max_transaction_bytes;
    std::uint64_t begun = 1 + 1 + leaving + kLatency;
    for (std::uint32_t i = 0; i < n; ++i) {
      while (begun % kInterval >= 4) ++begun;
      ++begun;
    }
    const std::uint64_t done = begun + kDepth + 1 + 1 + kMarkCycles;
    bench.wait_until_just_before(done);
    bench.checks().that(!output.can_pop(), "done a cycle too soon");
    output.pop(activity);
    bench.checks().equal(bench.clock().now_cycles(), done, "done in time");
  });
  bench.run();
  bench.check_counter("second_halves", 0);
}

// Quadrants of 8 px of each group of 16.
std::vector<std::vector<PixelRect>> quadrants(const std::vector<PixelRect>& groups) {
  std::vector<std::vector<PixelRect>> parts(4);
  for (const PixelRect& group : groups) {
    for (int p = 0; p < 4; ++p) {
      const int x = group.x0 + p % 2 * 8, y = group.y0 + p / 2 * 8;
      const PixelRect cut = intersection({x, y, x + 8, y + 8}, group);
      parts[static_cast<std::size_t>(p)].push_back(cut.empty() ? PixelRect{x, y, x, y} : cut);
    }
  }
  return parts;
}

// Four HFUs behind one fetch: each part of a group gets the splats that one HFU would make for it
// alone, and every half is read once.
void shared_fetch(Case& test, SecondHalfEncoding encoding, std::uint32_t slots) {
  constexpr std::uint32_t kParts = 4;
  SceneShape shape;
  shape.encoding = encoding;
  HfuPlan plan = hfu_plan_of(random_scene(test.random, shape));
  plan.config.second_half_slots = slots;
  plan.sorting_units = 1;
  add_shares(test.random, plan, 3, 150);
  const std::vector<PixelRect> groups = plan.scene.job.groups;
  plan.scene.job.parts = quadrants(groups);
  UnitBench bench(test, still_bench(memory_bytes(plan.scene.job)));
  Checks& checks = bench.checks();
  bench.load(0, plan.scene.image.bytes);
  auto& input = bench.add_fifo<VisitShare>("shares", 4, 1);
  auto& candidates = bench.add_fifo<FineCandidate>("candidates", 16, 12);
  const auto outputs = bench.add_fifos<SplatToken>("to_part", kParts, 4, 1);
  std::unique_ptr<CodebookBuffer> codebooks;
  if (plan.scene.job.layout.second_half.quantised()) {
    CodebookConfig full = plan.codebook;
    full.preloaded = true;
    codebooks = std::make_unique<CodebookBuffer>("codebooks", full, bench.context(plan.scene.job),
                                                 bench.instant_end(), kParts);
    bench.add_unit(*codebooks);
  }
  std::vector<std::unique_ptr<FinishedGroups>> finished;
  Hfu unit("hfu", plan.config, plan.codebook, FineFilterPlace{0, Rejects::kDropped},
           bench.context(plan.scene.job));
  unit.coarse.shares(input);
  unit.coarse.survivors(candidates);
  unit.fine.candidates(candidates);
  if (codebooks) unit.fine.codebooks(*codebooks);
  for (std::uint32_t p = 0; p < kParts; ++p) {
    finished.push_back(std::make_unique<FinishedGroups>(fmt::format("finished{}", p).c_str(),
                                                        bench.clock(), groups.size(), 1));
    unit.coarse.finished(*finished.back());
    unit.fine.finished(*finished.back());
    unit.fine.splats(*outputs[p]);
  }
  bench.add_unit(unit);
  bench.add_thread("vsu", [&](Activity& activity) {
    for (const VisitShare& share : plan.shares) input.push(share, activity);
  });
  // [share][slot] parts that it passes for.
  std::vector<std::vector<std::uint32_t>> wanted;
  std::uint64_t first_halves = 0;
  for (const VisitShare& share : plan.shares) {
    wanted.emplace_back(share.count, 0U);
    first_halves += share.count;
  }
  for (std::uint32_t p = 0; p < kParts; ++p) {
    HfuPlan alone = plan;
    alone.scene.job.groups = plan.scene.job.parts[p];
    std::vector<std::vector<Splat>> splats;
    for (std::size_t k = 0; k < plan.shares.size(); ++k) {
      const ExpectedShare expected = expect(alone, plan.shares[k]);
      const bool pixels = !alone.scene.job.groups[plan.shares[k].group].empty();
      for (std::size_t i = 0; i < wanted[k].size(); ++i) {
        wanted[k][i] += pixels && expected.passes[i] ? 1 : 0;
      }
      splats.push_back(pixels ? expected.splats : std::vector<Splat>{});
    }
    bench.add_thread(fmt::format("part{}", p), [&, p, splats](Activity& activity) {
      for (std::size_t k = 0; k < plan.shares.size(); ++k) {
        std::vector<std::uint32_t> got, should;
        SplatToken token = outputs[p]->pop(activity);
        for (; token.mark == Mark::kNone; token = outputs[p]->pop(activity)) {
          got.push_back(token.splat.index);
        }
        for (const Splat& splat : splats[k]) should.push_back(splat.index);
        checks.that(got == should, fmt::format("part {}, visit {}: splats", p, k));
        checks.that(token.mark == plan.shares[k].mark && token.visit == plan.shares[k].visit,
                    fmt::format("part {}, visit {}: end", p, k));
      }
    });
  }
  bench.run();
  std::uint64_t fetched = 0, taken = 0;
  for (const auto& share : wanted) {
    for (const std::uint32_t parts : share) {
      fetched += parts > 0 ? 1 : 0;
      taken += parts;
    }
  }
  bench.check_counter("first_halves", first_halves);
  bench.check_counter("coarse_tests", first_halves);
  bench.check_counter("coarse_tests_of_parts", kParts * first_halves);
  bench.check_counter("coarse_passed", taken);
  bench.check_counter("coarse_candidates", fetched);
  bench.check_counter("second_halves", fetched);
  bench.check_counter("second_halves_taken", taken);
  bench.check_counter("fine_tests", taken);
}

// Cycles of all orders of magnitude.
std::vector<std::uint64_t> random_cycles(std::mt19937_64& random, std::size_t count) {
  std::vector<std::uint64_t> cycles;
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint64_t below = std::uint64_t{1} << random() % 16;
    cycles.push_back(random() % below);
  }
  return cycles;
}

void random_case(Case& test) {
  std::mt19937_64& random = test.random;
  SceneShape shape = random_shape(random);
  shape.encoding = static_cast<SecondHalfEncoding>(random() % 4);
  shape.order = random() % 2 == 0 ? StorageOrder::kChunks : StorageOrder::kVoxels;
  HfuPlan plan = hfu_plan_of(random_scene(random, shape));
  HfuConfig& config = plan.config;
  plan.codebook.banks = 1 + static_cast<std::uint32_t>(random() % 16);
  plan.codebook.line_bytes = 4U << random() % 5;
  plan.codebook.latency_cycles = 1 + static_cast<std::uint32_t>(random() % 10);
  config.cfus = 1 + static_cast<std::uint32_t>(random() % 6);
  config.cfu_lanes = 1 + static_cast<std::uint32_t>(random() % 60);
  config.cfu_depth_cycles = 1 + static_cast<std::uint32_t>(random() % 20);
  config.ffus = random() % 3 == 0 ? 2 + static_cast<std::uint32_t>(random() % 8) : 1;
  config.ffu_lanes = 1 + static_cast<std::uint32_t>(random() % 430);
  config.coarse_filter = random() % 4 != 0;
  config.slice_gaussians = 2 * (1 + static_cast<std::uint32_t>(random() % 64));
  config.candidate_fifo_entries = 1 + static_cast<std::uint32_t>(random() % 16);
  config.second_half_slots = 1 + static_cast<std::uint32_t>(random() % 8);
  plan.sorting_units = 1 + static_cast<std::uint32_t>(random() % 3);
  const BenchConfig bench = random_bench(random, memory_bytes(plan.scene.job));
  plan.saturate_one_in = random() % 3 == 0 ? 10 : 0;
  if (bench.stall_probability > 0)
    plan.output_entries = 1 + static_cast<std::uint32_t>(random() % 4);
  add_shares(random, plan, random() % 4, 300);
  plan.feedback_cycles = 1 + static_cast<std::uint32_t>(random() % 100);
  if (random() % 3 == 0) plan.finish_cycles = random_cycles(random, plan.scene.job.groups.size());
  run_hfu(test, bench, plan);
}

}  // namespace
}  // namespace sgs::tb

int sc_main(int argc, char* argv[]) {
  using namespace sgs;
  using namespace sgs::tb;
  CaseRunner runner("tb_hfu", "Hierarchical filtering unit alone, against the filters' functions");
  // `visits` shares of each group, of at most so many slots.
  const auto add = [&](const std::string& name, std::size_t visits, std::uint32_t most, auto shape,
                       auto change) {
    runner.add_directed(name, [=](Case& test) {
      SceneShape own;
      shape(own);
      HfuPlan plan = hfu_plan_of(random_scene(test.random, own));
      change(plan);
      add_shares(test.random, plan, visits, most);
      run_hfu(test, still_bench(memory_bytes(plan.scene.job)), plan);
    });
  };
  const auto same = [](SceneShape&) {};
  const auto usual = [](HfuPlan&) {};
  const auto encoded = [](SecondHalfEncoding encoding, int degree) {
    return [=](SceneShape& shape) {
      shape.encoding = encoding;
      shape.sh_degree = degree;
    };
  };
  add("end-of-group marks only", 0, 0, same, usual);
  add("empty visits", 3, 0, same, usual);
  add("one Gaussian", 3, 1, same, usual);
  const auto large = [](SceneShape& shape) { shape.gaussians = 2000; };
  add("shares of several slices", 2, 2000, large, usual);
  for (int degree = 0; degree <= 3; ++degree) {
    for (const auto& [name, order] :
         {std::pair{"voxels", StorageOrder::kVoxels}, {"chunks", StorageOrder::kChunks}}) {
      add(
          fmt::format("by {}, SH degree {}", name, degree), 2, 100,
          [degree, by = order](SceneShape& shape) {
            shape.sh_degree = degree;
            shape.order = by;
          },
          usual);
    }
  }
  for (const auto& [name, encoding] : {std::pair{"half", SecondHalfEncoding::kHalf},
                                       {"vq", SecondHalfEncoding::kVq},
                                       {"vq_packed", SecondHalfEncoding::kVqPacked}}) {
    for (const int degree : {0, 3}) {
      add(fmt::format("{}, SH degree {}", name, degree), 2, 100, encoded(encoding, degree), usual);
    }
  }
  add("decoding binds: an FFU of one cycle, lines of 4 B", 2, 200,
      encoded(SecondHalfEncoding::kVqPacked, 3), [](HfuPlan& plan) {
        plan.config.ffu_lanes = 10000;
        plan.codebook.line_bytes = 4;
      });
  add("no coarse filter", 2, 100, same, [](HfuPlan& plan) { plan.config.coarse_filter = false; });
  add("one slot for second halves", 2, 100, same, [](HfuPlan& plan) {
    plan.config.second_half_slots = 1;
    plan.config.candidate_fifo_entries = 1;
  });
  const auto pixel = [](SceneShape& shape) { shape.width_px = shape.height_px = 1; };
  add("1x1 frame", 2, 100, pixel, usual);
  const auto finished_in = [](std::uint64_t cycle) {
    return [=](HfuPlan& plan) { plan.finish_cycles.assign(plan.scene.job.groups.size(), cycle); };
  };
  add("groups finished before they begin", 4, 200, same, finished_in(0));
  add("groups that are finished at once", 4, 200, same,
      [](HfuPlan& plan) { plan.saturate_one_in = 1; });
  for (const std::uint64_t cycle : {0U, 1U, 30U, 60U, 100U, 200U, 400U, 1000U}) {
    add(
        fmt::format("groups that are finished in cycle {}", cycle), 2, 200,
        [](SceneShape& shape) { shape.encoding = SecondHalfEncoding::kVq; },
        [=](HfuPlan& plan) {
          plan.feedback_cycles = 3;
          finished_in(cycle)(plan);
        });
  }
  for (const std::uint32_t slots : {1U, 6U, 40U}) {
    for (const auto& [name, encoding] :
         {std::pair{"", SecondHalfEncoding::kRaw}, {", vq", SecondHalfEncoding::kVq}}) {
      runner.add_directed(fmt::format("four HFUs behind one fetch, {} slots{}", slots, name),
                          [slots, how = encoding](Case& test) { shared_fetch(test, how, slots); });
    }
  }
  for (const std::uint32_t n : {1U, 4U, 5U, 100U, 128U}) {
    runner.add_directed(fmt::format("time of the coarse filter for {}", n),
                        [n](Case& test) { exact_coarse_time(test, n); });
  }
  runner.set_random(random_case);
  return runner.run(argc, argv);
}
