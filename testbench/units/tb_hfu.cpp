// Hierarchical filtering unit alone: shares of visits in, splats out to several sorting units.
// Checked against the coarse bound and make_splat on what the bytes in memory decode to; times
// against hfu_timing_model.h.
#include <algorithm>
#include <memory>
#include <optional>

#include "algorithm/splat/coarse_bound.h"
#include "algorithm/splat/make_splat.h"
#include "modules/hfu/hfu.h"
#include "testbench/units/case_runner.h"
#include "testbench/units/hfu_timing_model.h"
#include "testbench/units/random_scene.h"
#include "testbench/units/random_splats.h"
#include "testbench/units/unit_bench.h"

namespace sgs::tb {
namespace {

struct Plan {
  HfuConfig config;
  CodebookConfig codebook;
  TestScene scene;
  std::vector<VisitShare> shares;
  std::uint32_t sorting_units = 2;
  std::uint32_t output_entries = 4096;
  int saturate_one_in = 0;       // 0: never; else how often a reader reports a group as finished
  bool finished_before = false;  // all groups are reported before the first share comes
};

// What must come of one share, slot by slot.
struct ExpectedShare {
  std::vector<bool> passes;          // coarse filter
  std::vector<std::uint32_t> lines;  // of the codebook buffer, of each Gaussian's record
  std::vector<Splat> splats;
};

DecodedGaussian decode_slot(const TestScene& scene, std::uint32_t slot) {
  const MemoryLayout& layout = scene.job.layout;
  const std::byte* bytes = scene.image.bytes.data();
  return decode_second_half(
      layout.second_half, decode_first_half(bytes + layout.first_half_address(slot)),
      bytes + layout.second_half_address(slot), bytes + layout[Region::kCodebooks].base);
}

// Lines that hold a byte of one of the record's entries, counted entry by entry.
std::uint32_t lines_of(const Plan& plan, std::uint32_t slot) {
  const MemoryLayout& layout = plan.scene.job.layout;
  const SecondHalfFormat& format = layout.second_half;
  const CodebookIndices indices =
      decode_indices(format, plan.scene.image.bytes.data() + layout.second_half_address(slot));
  std::uint32_t lines = 0;
  for (std::size_t id = 0; id < kCodebookCount; ++id) {
    if (format.entries[id] == 0) continue;
    const EntryRange range = format.entry(static_cast<Codebook>(id), indices[id]);
    const std::uint32_t end = range.begin + range.bytes;
    for (std::uint32_t line = 0; line < format.codebook_bytes(); line += plan.codebook.line_bytes) {
      lines += line < end && line + plan.codebook.line_bytes > range.begin ? 1 : 0;
    }
  }
  return lines;
}

ExpectedShare expect(const Plan& plan, const VisitShare& share) {
  ExpectedShare out;
  const TestScene& scene = plan.scene;
  const PixelRect& pixels = scene.job.groups[share.group];
  for (std::uint32_t slot = share.first; slot < share.first + share.count; ++slot) {
    const DecodedGaussian decoded = decode_slot(scene, slot);
    const Gaussian<float>& g = decoded.gaussian;
    const CoarseBound bound =
        coarse_bound(scene.job.view, g.mean, std::max({g.scale.x, g.scale.y, g.scale.z}));
    const bool near = bound.in_front && touches(bound, pixels);
    out.passes.push_back(near || !plan.config.coarse_filter);
    if (scene.job.layout.second_half.quantised()) out.lines.push_back(lines_of(plan, slot));
    Splat splat{};
    // What the coarse filter would drop must not come through the fine one either.
    if (!near || !make_geometry(scene.job.view, g, splat) || !reaches_group(splat, pixels))
      continue;
    add_colour(scene.job.view, scene.job.layout.sh_degree(), g.mean, decoded.sh, splat);
    splat.index = slot;
    out.splats.push_back(splat);
  }
  return out;
}

struct Totals {
  std::uint64_t gaussians = 0, candidates = 0, splats = 0;
};

// One share's splats as they came out: all of them, or of a finished group some, in order.
void check_share(Checks& checks, const Plan& plan, const VisitShare& share,
                 const ExpectedShare& expected, const std::vector<Splat>& got, bool finished) {
  const SubtileRect group = subtiles_of(plan.scene.job.groups[share.group]);
  const std::string where = fmt::format("visit {}", share.visit);
  if (!finished) checks.equal(got.size(), expected.splats.size(), where + ": splats");
  auto next = expected.splats.begin();
  for (const Splat& splat : got) {
    next = std::find_if(next, expected.splats.end(),
                        [&](const Splat& s) { return s.index == splat.index; });
    if (next == expected.splats.end()) {
      checks.that(false, fmt::format("{}: a splat of slot {} out of order", where, splat.index));
      return;
    }
    const std::string differs = difference(splat, *next++, group);
    checks.that(differs.empty(), fmt::format("{}, slot {}: {}", where, splat.index, differs));
  }
}

// Null where the scene has none. (Its loading is tb_codebook's.)
std::unique_ptr<CodebookBuffer> full_codebooks(UnitBench& bench, const Plan& plan) {
  const MemoryLayout& layout = plan.scene.job.layout;
  if (!layout.second_half.quantised()) return nullptr;
  auto codebooks = std::make_unique<CodebookBuffer>("codebooks", plan.codebook, bench.clock(),
                                                    plan.scene.job, bench.port());
  codebooks->preload(plan.scene.image.bytes.data() + layout[Region::kCodebooks].base);
  return codebooks;
}

void run_plan(Case& test, const BenchConfig& bench_config, const Plan& plan) {
  UnitBench bench(test, bench_config);
  Checks& checks = bench.checks();
  bench.load(0, plan.scene.image.bytes);
  SaturationBoard board(plan.scene.job.groups.size());
  for (std::uint32_t g = 0; plan.finished_before && g < plan.scene.job.groups.size(); ++g) {
    board.set(g);
  }
  const bool free_running = bench_config.memory == Memory::kFixedLatency &&
                            bench_config.stall_probability == 0 && plan.saturate_one_in == 0 &&
                            !plan.finished_before;
  auto& input = bench.add_fifo<VisitShare>(
      "shares", free_running ? static_cast<std::uint32_t>(plan.shares.size() + 1) : 4, 1);
  std::vector<TimedFifo<SplatToken>*> outputs;
  for (std::uint32_t s = 0; s < plan.sorting_units; ++s) {
    outputs.push_back(
        &bench.add_fifo<SplatToken>(fmt::format("to_sorting{}", s), plan.output_entries, 1));
  }
  const std::unique_ptr<CodebookBuffer> codebooks = full_codebooks(bench, plan);
  Hfu unit("hfu", plan.config, bench.clock(), plan.scene.job, board, bench.port(), codebooks.get(),
           input, outputs);

  std::vector<ExpectedShare> expected;
  std::vector<std::vector<bool>> passes;
  std::optional<DecodeTiming> decode;
  if (codebooks) decode = DecodeTiming{plan.codebook.latency_cycles, {}};
  Totals totals;
  for (const VisitShare& share : plan.shares) {
    expected.push_back(expect(plan, share));
    passes.push_back(expected.back().passes);
    if (decode) decode->lines.push_back(expected.back().lines);
    totals.gaussians += share.count;
    totals.candidates +=
        static_cast<std::uint64_t>(std::count(passes.back().begin(), passes.back().end(), true));
    totals.splats += expected.back().splats.size();
  }
  const HfuTimes times = hfu_times(plan.config, passes, bench_config.latency_cycles, decode);
  bench.add_thread("vsu", [&](Activity& activity) {
    for (const VisitShare& share : plan.shares) input.push(share, activity);
  });
  for (std::uint32_t s = 0; s < plan.sorting_units; ++s) {
    bench.add_thread(fmt::format("sorting{}", s), [&, s](Activity& activity) {
      for (std::size_t k = 0; k < plan.shares.size(); ++k) {
        const VisitShare& share = plan.shares[k];
        if (share.visit % plan.sorting_units != s) continue;
        std::vector<Splat> got;
        SplatToken token = outputs[s]->pop(activity);
        for (; token.mark == Mark::kNone; token = outputs[s]->pop(activity)) {
          checks.equal(token.visit, share.visit, "visit of a splat");
          checks.equal(token.group, share.group, "group of a splat");
          got.push_back(token.splat);
          if (plan.saturate_one_in > 0 &&
              test.random() % static_cast<unsigned>(plan.saturate_one_in) == 0) {
            board.set(share.group);
          }
        }
        checks.that(
            token.mark == share.mark && token.visit == share.visit && token.group == share.group,
            fmt::format("visit {}: its end", share.visit));
        check_share(checks, plan, share, expected[k], got, board.saturated(share.group));
        if (free_running) {
          // One cycle for the FIFO.
          checks.equal(bench.clock().now_cycles(), times.shares_done[k] + 1,
                       fmt::format("visit {}: cycle of its end", share.visit));
        }
      }
    });
  }
  bench.run(unit);
  bench.check_times(unit.activities());

  const HfuCounters& counters = unit.counters();
  const std::uint64_t second_bytes = plan.scene.job.layout.second_half_bytes();
  checks.equal(counters.visits, plan.shares.size(), "shares");
  checks.equal(bench.port().bytes_read(),
               counters.first_halves * kFirstHalfBytes + counters.second_halves * second_bytes,
               "bytes read");
  if (plan.finished_before) {
    checks.equal(counters.first_halves, 0U, "first halves of finished groups");
    checks.equal(counters.dropped_saturated, totals.gaussians, "dropped");
    return;
  }
  if (plan.saturate_one_in > 0) {
    checks.that(!codebooks || (codebooks->counters().records <= counters.second_halves &&
                               codebooks->counters().records >= counters.fine_tests),
                "records decoded");
    checks.that(counters.first_halves <= totals.gaussians &&
                    counters.second_halves <= totals.candidates && counters.splats <= totals.splats,
                "more work than there is");
    return;
  }
  checks.equal(counters.first_halves, totals.gaussians, "first halves");
  checks.equal(counters.coarse_tests, plan.config.coarse_filter ? totals.gaussians : 0,
               "coarse tests");
  checks.equal(counters.second_halves, totals.candidates, "second halves");
  checks.equal(counters.fine_tests, totals.candidates, "fine tests");
  checks.equal(counters.splats, totals.splats, "splats");
  checks.equal(counters.dropped_saturated, 0U, "dropped");
  checks.equal(unit.coarse_activity().busy_cycles(), times.coarse_busy, "busy cycles, coarse");
  checks.equal(unit.fine_activity().busy_cycles(), times.fine_busy, "busy cycles, fine");
  if (!codebooks) return;
  checks.equal(codebooks->counters().records, totals.candidates, "records decoded");
  checks.equal(codebooks->counters().lines, times.decode_busy, "lines read");
  checks.equal(codebooks->counters().conflict_cycles, 0U, "bank conflicts of one reader");
  checks.equal(unit.decode_activity()->busy_cycles(), times.decode_busy, "busy cycles, decode");
}

Plan plan_of(TestScene scene) {
  Plan plan;
  plan.scene = std::move(scene);
  return plan;
}

BenchConfig still_bench(const Plan& plan, std::uint32_t latency_cycles = 20) {
  BenchConfig config;
  config.latency_cycles = latency_cycles;
  config.memory_bytes = plan.scene.job.layout.total_bytes();
  return config;
}

// `visits` shares of random slots for each group, then the group's end.
void add_shares(std::mt19937_64& random, Plan& plan, std::size_t visits, std::uint32_t most) {
  const std::uint32_t stored = plan.scene.job.layout.gaussian_count;
  std::uint32_t number = 0;
  for (std::uint32_t group = 0; group < plan.scene.job.groups.size(); ++group) {
    for (std::size_t left = visits; left > 0; --left) {
      const auto count = static_cast<std::uint32_t>(random() % (std::min(stored, most) + 1));
      const auto first = static_cast<std::uint32_t>(random() % (stored - count + 1));
      plan.shares.push_back({group, number++, first, count, Mark::kEndOfVisit});
    }
    plan.shares.push_back({group, number++, 0, 0, Mark::kEndOfGroup});
  }
}

void directed(Case& test, const SceneShape& shape, const HfuConfig& config, std::size_t visits,
              std::uint32_t most) {
  Plan plan = plan_of(random_scene(test.random, shape));
  plan.config = config;
  add_shares(test.random, plan, visits, most);
  run_plan(test, still_bench(plan), plan);
}

// n Gaussians behind the camera: none passes, so the mark is there after the time of the coarse
// filter alone, written out here: FIFO 1, start of the read 1, memory, ceil(n / 4) intervals, depth
// of the CFU, two FIFOs.
void exact_coarse_time(Case& test, std::uint32_t n) {
  SceneShape shape;
  Plan plan = plan_of(random_scene(test.random, shape));
  for (Gaussian<float>& g : plan.scene.cloud.gaussians) {
    const auto& view = plan.scene.job.view;
    for (int axis = 0; axis < 3; ++axis) {
      g.mean[axis] = view.position[axis] - 2 * view.cam_from_world[2][axis];
    }
  }
  plan.scene.grid = build_voxel_grid(plan.scene.cloud, shape.voxel_size);
  plan.scene.image = build_memory_image(encode_raw(plan.scene.cloud), plan.scene.grid);
  plan.scene.job.layout = with_working_regions(plan.scene.image.layout, 0, 4096);
  constexpr std::uint64_t kLatency = 37, kInterval = 14, kDepth = 12;  // ceil(55 / 4)
  UnitBench bench(test, still_bench(plan, kLatency));
  bench.load(0, plan.scene.image.bytes);
  SaturationBoard board(plan.scene.job.groups.size());
  auto& input = bench.add_fifo<VisitShare>("shares", 4, 1);
  auto& output = bench.add_fifo<SplatToken>("to_sorting0", 4, 1);
  Hfu unit("hfu", plan.config, bench.clock(), plan.scene.job, board, bench.port(), nullptr, input,
           {&output});
  bench.add_thread("vsu", [&](Activity& activity) {
    input.push({0, 0, 0, n, Mark::kEndOfVisit}, activity);
  });
  bench.add_thread("sorting0", [&](Activity& activity) {
    bench.clock().wait_cycles(1 + 1 + kLatency + (n + 3) / 4 * kInterval + kDepth + 1 + 1 - 1);
    bench.checks().that(!output.can_pop(), "done a cycle too soon");
    bench.clock().wait_cycles(1);
    sc_core::wait(sc_core::SC_ZERO_TIME);
    bench.checks().that(output.can_pop(), "not done in time");
    output.pop(activity);
  });
  bench.run(unit);
  bench.checks().equal(unit.counters().second_halves, 0U, "second halves");
}

void random_case(Case& test) {
  std::mt19937_64& random = test.random;
  SceneShape shape = random_shape(random);
  shape.encoding = static_cast<SecondHalfEncoding>(random() % 4);
  Plan plan = plan_of(random_scene(random, shape));
  HfuConfig& config = plan.config;
  plan.codebook.banks = 1 + static_cast<std::uint32_t>(random() % 16);
  plan.codebook.line_bytes = 4U << random() % 5;
  plan.codebook.latency_cycles = 1 + static_cast<std::uint32_t>(random() % 10);
  config.cfus = 1 + static_cast<std::uint32_t>(random() % 6);
  config.cfu_lanes = 1 + static_cast<std::uint32_t>(random() % 60);
  config.cfu_depth_cycles = 1 + static_cast<std::uint32_t>(random() % 20);
  config.ffu_lanes = 1 + static_cast<std::uint32_t>(random() % 430);
  config.coarse_filter = random() % 4 != 0;
  config.slice_gaussians = 2 * (1 + static_cast<std::uint32_t>(random() % 64));
  config.candidate_fifo_entries = 1 + static_cast<std::uint32_t>(random() % 16);
  config.second_half_slots = 1 + static_cast<std::uint32_t>(random() % 8);
  plan.sorting_units = 1 + static_cast<std::uint32_t>(random() % 3);
  const BenchConfig bench = random_bench(random, plan.scene.job.layout.total_bytes());
  plan.saturate_one_in = random() % 3 == 0 ? 10 : 0;
  if (bench.stall_probability > 0)
    plan.output_entries = 1 + static_cast<std::uint32_t>(random() % 4);
  add_shares(random, plan, random() % 4, 300);
  run_plan(test, bench, plan);
}

}  // namespace
}  // namespace sgs::tb

int sc_main(int argc, char* argv[]) {
  using namespace sgs;
  using namespace sgs::tb;
  CaseRunner runner("tb_hfu", "Hierarchical filtering unit alone, against the filters' functions");
  const SceneShape shape;
  runner.add_directed("end-of-group marks only",
                      [=](Case& test) { directed(test, shape, {}, 0, 0); });
  runner.add_directed("empty visits", [=](Case& test) { directed(test, shape, {}, 3, 0); });
  runner.add_directed("one Gaussian", [=](Case& test) { directed(test, shape, {}, 3, 1); });
  runner.add_directed("shares of several slices", [=](Case& test) {
    SceneShape large = shape;
    large.gaussians = 2000;
    directed(test, large, {}, 2, 2000);
  });
  for (int degree = 0; degree <= 3; ++degree) {
    runner.add_directed(fmt::format("SH degree {}", degree), [=](Case& test) {
      SceneShape of_degree = shape;
      of_degree.sh_degree = degree;
      directed(test, of_degree, {}, 2, 100);
    });
  }
  for (const auto& [name, encoding] : {std::pair{"half", SecondHalfEncoding::kHalf},
                                       {"vq", SecondHalfEncoding::kVq},
                                       {"vq_packed", SecondHalfEncoding::kVqPacked}}) {
    for (const int degree : {0, 3}) {
      runner.add_directed(fmt::format("{}, SH degree {}", name, degree), [=](Case& test) {
        SceneShape encoded = shape;
        encoded.encoding = encoding;
        encoded.sh_degree = degree;
        directed(test, encoded, {}, 2, 100);
      });
    }
  }
  runner.add_directed("decoding binds: an FFU of one cycle, lines of 4 B", [=](Case& test) {
    SceneShape encoded = shape;
    encoded.encoding = SecondHalfEncoding::kVqPacked;
    encoded.sh_degree = 3;
    Plan plan = plan_of(random_scene(test.random, encoded));
    plan.config.ffu_lanes = 10000;
    plan.codebook.line_bytes = 4;
    add_shares(test.random, plan, 2, 200);
    run_plan(test, still_bench(plan), plan);
  });
  runner.add_directed("no coarse filter", [=](Case& test) {
    HfuConfig config;
    config.coarse_filter = false;
    directed(test, shape, config, 2, 100);
  });
  runner.add_directed("one slot for second halves", [=](Case& test) {
    HfuConfig config;
    config.second_half_slots = 1;
    config.candidate_fifo_entries = 1;
    directed(test, shape, config, 2, 100);
  });
  runner.add_directed("1x1 frame", [=](Case& test) {
    SceneShape pixel = shape;
    pixel.width_px = pixel.height_px = 1;
    directed(test, pixel, {}, 2, 100);
  });
  runner.add_directed("groups finished before they begin", [=](Case& test) {
    Plan plan = plan_of(random_scene(test.random, shape));
    plan.finished_before = true;
    add_shares(test.random, plan, 4, 200);
    run_plan(test, still_bench(plan), plan);
  });
  runner.add_directed("groups that are finished at once", [=](Case& test) {
    Plan plan = plan_of(random_scene(test.random, shape));
    plan.saturate_one_in = 1;
    add_shares(test.random, plan, 4, 200);
    run_plan(test, still_bench(plan), plan);
  });
  for (const std::uint32_t n : {1U, 4U, 5U, 100U, 128U}) {
    runner.add_directed(fmt::format("time of the coarse filter for {}", n),
                        [n](Case& test) { exact_coarse_time(test, n); });
  }
  runner.set_random(random_case);
  return runner.run(argc, argv);
}
