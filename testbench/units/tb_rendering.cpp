// Rendering unit alone: sorted splats in, a frame buffer in memory out. Checked against GroupState;
// times against a recurrence over the groups.
#include "algorithm/render/group_state.h"
#include "modules/rendering/rendering_unit.h"
#include "testbench/units/case_runner.h"
#include "testbench/units/random_splats.h"
#include "testbench/units/unit_bench.h"

namespace sgs::tb {
namespace {

struct Plan {
  RenderingConfig config;
  FrameJob job;
  std::uint32_t inputs = 2;
  Arrival arrival = Arrival::kByVisit;
  std::uint32_t input_entries = 8;
  std::vector<std::vector<std::vector<Splat>>> groups;  // [group][visit] front to back
};

std::uint64_t ceil_div(std::uint64_t a, std::uint64_t b) { return (a + b - 1) / b; }

// What must come out, from the algorithm layer.
struct Expected {
  std::vector<std::byte> frame;
  RenderingCounters counters;
  std::vector<bool> saturated;              // [group]
  std::vector<std::uint64_t> blend_cycles;  // [group]
  std::vector<std::uint64_t> drain_cycles;  // [group]
};

Expected expect(const Plan& plan) {
  Expected out;
  RenderResult frame;
  frame.image = Image(plan.job.view.width, plan.job.view.height);
  frame.transmittance.resize(frame.image.pixels.size());
  frame.contributors.resize(frame.image.pixels.size());
  for (std::size_t g = 0; g < plan.groups.size(); ++g) {
    const PixelRect& pixels = plan.job.groups[g];
    GroupState state(pixels, plan.job.view.width, plan.job.view.height,
                     plan.config.ellipse_test ? SubtileTest::kEllipse : SubtileTest::kBox);
    std::uint64_t cycles = 0;
    for (const auto& visit : plan.groups[g]) {
      for (const Splat& splat : visit) {
        if (state.saturated()) {
          ++out.counters.splats_saturated;
          continue;
        }
        const BlendWork work = state.blend(splat);
        cycles += std::max({std::uint64_t{1}, ceil_div(work.blended, plan.config.clusters),
                            ceil_div(work.tested, plan.config.subtile_tests_per_cycle)});
        out.counters.subtile_tests += work.tested;
        out.counters.subtile_blends += work.blended;
        out.counters.splats += work.blended > 0 ? 1 : 0;
      }
      cycles += plan.arrival == Arrival::kByToken ? 1 : 0;  // a rejected key
    }
    ++out.counters.groups;
    out.counters.groups_saturated += state.saturated() ? 1 : 0;
    out.counters.contributors += state.contributors();
    out.saturated.push_back(state.saturated());
    out.blend_cycles.push_back(cycles);
    out.drain_cycles.push_back(
        static_cast<std::uint64_t>(pixels.height()) *
        ceil_div(static_cast<std::uint64_t>(pixels.width()), plan.config.drain_pixels_per_cycle));
    state.store(plan.job.background, frame);
  }
  out.frame = encode_frame(plan.job.frame_format, frame.image);
  return out;
}

// End of the frame when splats are always there: a group is blended when the one before it is and a
// buffer is free; drained when the one before it is, depth_cycles after its last blend.
std::uint64_t expected_end(const Plan& plan, const Expected& expected,
                           std::uint64_t latency_cycles) {
  std::vector<std::uint64_t> drained;
  std::uint64_t blend_end = 1;  // input latency
  for (std::size_t g = 0; g < plan.groups.size(); ++g) {
    const std::size_t buffers = plan.config.pixel_buffers;
    if (g >= buffers) blend_end = std::max(blend_end, drained[g - buffers]);
    blend_end += expected.blend_cycles[g];
    std::uint64_t drain = blend_end + plan.config.depth_cycles;
    if (g > 0) drain = std::max(drain, drained[g - 1]);
    drained.push_back(drain + expected.drain_cycles[g]);
  }
  return drained.back() + latency_cycles;
}

// What comes through each FIFO. By visit: visits in turn, each with its end; behind a group's
// visits its end takes a turn of its own. By token: each in turn, here with a rejected key behind a
// visit's splats.
std::vector<std::vector<SplatToken>> tokens_of(const Plan& plan) {
  std::vector<std::vector<SplatToken>> tokens(plan.inputs);
  const bool by_token = plan.arrival == Arrival::kByToken;
  std::uint32_t turn = 0, visit = 0;
  for (std::uint32_t g = 0; g < plan.groups.size(); ++g) {
    const auto put = [&](const Splat& splat, Mark mark) {
      tokens[turn % plan.inputs].push_back({splat, g, visit, mark});
      turn += mark != Mark::kNone || by_token ? 1 : 0;
    };
    for (const auto& splats : plan.groups[g]) {
      for (const Splat& splat : splats) put(splat, Mark::kNone);
      put({}, by_token ? Mark::kRejected : Mark::kEndOfVisit);
      ++visit;
    }
    put({}, Mark::kEndOfGroup);
    ++visit;
  }
  return tokens;
}

void run_plan(Case& test, const BenchConfig& bench_config, const Plan& plan) {
  UnitBench bench(test, bench_config);
  Checks& checks = bench.checks();
  SaturationBoard board(plan.job.groups.size());
  std::vector<TimedFifo<SplatToken>*> inputs;
  for (std::uint32_t s = 0; s < plan.inputs; ++s) {
    inputs.push_back(
        &bench.add_fifo<SplatToken>(fmt::format("sorted{}", s), plan.input_entries, 1));
  }
  std::uint64_t ends = 0, end_cycle = 0;
  RenderingUnit unit("rendering", plan.config, bench.clock(), plan.job, board, bench.port(), inputs,
                     plan.arrival, [&] {
                       ++ends;
                       end_cycle = bench.clock().now_cycles();
                     });
  const std::vector<std::vector<SplatToken>> tokens = tokens_of(plan);
  for (std::uint32_t s = 0; s < plan.inputs; ++s) {
    bench.add_thread(fmt::format("sorting{}", s), [&, s](Activity& activity) {
      for (const SplatToken& token : tokens[s]) inputs[s]->push(token, activity);
    });
  }
  const Expected expected = expect(plan);
  const bool free_running =
      bench_config.memory == Memory::kFixedLatency && bench_config.stall_probability == 0;
  if (free_running) {
    bench.add_thread("clock", [&](Activity&) {
      bench.clock().wait_cycles(expected_end(plan, expected, bench_config.latency_cycles) - 1);
      checks.equal(ends, 0U, "done a cycle too soon");
      bench.clock().wait_cycles(1);
      sc_core::wait(sc_core::SC_ZERO_TIME);
      checks.equal(ends, 1U, "done in time");
    });
  }
  bench.run(unit);
  bench.check_times(unit.activities());

  checks.equal(ends, 1U, "ends of the frame reported");
  const RegionRange& frame = plan.job.layout[Region::kFrameBuffer];
  checks.that(bench.read_back(frame.base, frame.bytes) == expected.frame,
              "the frame buffer differs from GroupState's pixels");
  checks.equal(bench.port().bytes_written(), frame.bytes, "bytes written");
  checks.equal(bench.port().bytes_read(), 0U, "bytes read");
  const RenderingCounters& got = unit.counters();
  const RenderingCounters& want = expected.counters;
  checks.equal(got.groups, want.groups, "groups");
  checks.equal(got.groups_saturated, want.groups_saturated, "groups saturated");
  checks.equal(got.splats, want.splats, "splats");
  checks.equal(got.splats_saturated, want.splats_saturated, "splats of finished groups");
  checks.equal(got.subtile_tests, want.subtile_tests, "sub-tile tests");
  checks.equal(got.subtile_blends, want.subtile_blends, "sub-tile blends");
  checks.equal(got.contributors, want.contributors, "contributors");
  std::uint64_t blend = 0, drain = 0;
  for (std::uint32_t g = 0; g < plan.groups.size(); ++g) {
    checks.equal(board.saturated(g), expected.saturated[g] && plan.config.saturation_feedback,
                 fmt::format("feedback of group {}", g));
    blend += expected.blend_cycles[g];
    drain += expected.drain_cycles[g];
  }
  checks.equal(unit.blend_activity().busy_cycles(), blend, "busy cycles of blending");
  checks.equal(unit.drain_activity().busy_cycles(), drain, "busy cycles of draining");
}

Plan make_plan(int width_px, int height_px, int group_px, FrameFormat format) {
  Plan plan;
  plan.job = frame_job(width_px, height_px, group_px, format, 0);
  plan.groups.resize(plan.job.groups.size());
  plan.input_entries = 4096;
  return plan;
}

std::vector<Splat> random_visit(std::mt19937_64& random, const Plan& plan, std::size_t group,
                                std::size_t splats, float opacity) {
  std::vector<Splat> visit;
  for (std::size_t i = 0; i < splats; ++i) {
    visit.push_back(random_splat(random, plan.job.groups[group], plan.job,
                                 static_cast<std::uint32_t>(i), opacity));
  }
  return visit;
}

BenchConfig still_bench(const Plan& plan) {
  BenchConfig config;
  config.memory_bytes = plan.job.layout.total_bytes();
  return config;
}

// A splat that hides all of a group: flat, opaque, as wide as the frame.
Splat curtain(const Plan& plan) {
  Splat splat{};
  splat.conic_a = splat.conic_c = 1e-12F;
  splat.opacity = 1;
  splat.depth = 1;
  splat.rgb = {1, 0.5F, 0.25F};
  splat.footprint = subtiles_of({0, 0, plan.job.view.width, plan.job.view.height});
  return splat;
}

void random_case(Case& test) {
  std::mt19937_64& random = test.random;
  Plan plan = make_plan(1 + static_cast<int>(random() % 150), 1 + static_cast<int>(random() % 90),
                        4 * (1 + static_cast<int>(random() % 24)),
                        random() % 2 == 0 ? FrameFormat::kRgb8 : FrameFormat::kRgb32f);
  plan.inputs = 1 + static_cast<std::uint32_t>(random() % 3);
  plan.config.clusters = 1 + static_cast<std::uint32_t>(random() % 6);
  plan.config.pixel_buffers = 1 + static_cast<std::uint32_t>(random() % 2);
  plan.config.depth_cycles = 1 + static_cast<std::uint32_t>(random() % 20);
  plan.config.drain_pixels_per_cycle = 1 + static_cast<std::uint32_t>(random() % 16);
  plan.config.saturation_feedback = random() % 2 == 0;
  plan.config.ellipse_test = random() % 2 == 0;
  plan.config.subtile_tests_per_cycle = 1 + static_cast<std::uint32_t>(random() % 16);
  plan.arrival = random() % 2 == 0 ? Arrival::kByVisit : Arrival::kByToken;
  const BenchConfig bench = random_bench(random, plan.job.layout.total_bytes());
  // With stalls, tokens may as well wait for room.
  if (bench.stall_probability > 0) {
    plan.input_entries = 1 + static_cast<std::uint32_t>(random() % 8);
  }
  for (std::size_t g = 0; g < plan.groups.size(); ++g) {
    for (std::size_t visits = random() % 4; visits > 0; --visits) {
      plan.groups[g].push_back(random_visit(random, plan, g, random() % 12, 1.0F));
      if (random() % 4 == 0) plan.groups[g].back().resize(random() % 6 + 1, curtain(plan));
    }
  }
  run_plan(test, bench, plan);
}

void directed(Case& test, Plan plan, std::size_t splats) {
  for (std::size_t g = 0; g < plan.groups.size(); ++g) {
    plan.groups[g].push_back(random_visit(test.random, plan, g, splats, 1.0F));
  }
  run_plan(test, still_bench(plan), plan);
}

}  // namespace
}  // namespace sgs::tb

int sc_main(int argc, char* argv[]) {
  using namespace sgs;
  using namespace sgs::tb;
  CaseRunner runner("tb_rendering", "Rendering unit alone, against the blending of one group");
  const auto format = FrameFormat::kRgb32f;
  runner.add_directed("end-of-group marks only", [](Case& test) {
    const Plan plan = make_plan(64, 48, 16, format);
    run_plan(test, still_bench(plan), plan);
  });
  runner.add_directed("empty visits",
                      [](Case& test) { directed(test, make_plan(64, 48, 32, format), 0); });
  runner.add_directed("one splat",
                      [](Case& test) { directed(test, make_plan(16, 16, 16, format), 1); });
  runner.add_directed("1x1 frame",
                      [](Case& test) { directed(test, make_plan(1, 1, 64, format), 5); });
  runner.add_directed("groups cut by the frame's edge",
                      [](Case& test) { directed(test, make_plan(70, 33, 32, format), 20); });
  runner.add_directed("8-bit pixels", [](Case& test) {
    directed(test, make_plan(70, 33, 32, FrameFormat::kRgb8), 20);
  });
  runner.add_directed("two pixel buffers", [](Case& test) {
    Plan plan = make_plan(128, 64, 32, format);
    plan.config.pixel_buffers = 2;
    directed(test, plan, 50);
  });
  runner.add_directed("every token from another FIFO", [](Case& test) {
    Plan plan = make_plan(64, 48, 32, format);
    plan.arrival = Arrival::kByToken;
    plan.inputs = 4;
    directed(test, plan, 30);
  });
  runner.add_directed("saturated group", [](Case& test) {
    Plan plan = make_plan(64, 32, 32, format);
    // T falls to 0.01 and 0.0001; the next would bring it below: three splats finish every pixel.
    plan.groups[0].push_back(std::vector<Splat>(10, curtain(plan)));
    plan.groups[0].push_back(random_visit(test.random, plan, 0, 10, 1.0F));
    plan.groups[1].push_back(random_visit(test.random, plan, 1, 10, 0.5F));
    run_plan(test, still_bench(plan), plan);
  });
  runner.add_directed("splats behind finished sub-tiles of an unfinished group", [](Case& test) {
    Plan plan = make_plan(32, 32, 32, format);
    Splat left = curtain(plan);
    left.footprint.x1 = 4;
    plan.groups[0].push_back(std::vector<Splat>(10, left));  // the last take a cycle for nothing
    run_plan(test, still_bench(plan), plan);
  });
  runner.add_directed("splats too faint to be blended", [](Case& test) {
    Plan plan = make_plan(32, 32, 32, format);
    plan.groups[0].push_back(random_visit(test.random, plan, 0, 10, 0.001F));
    run_plan(test, still_bench(plan), plan);
  });
  runner.set_random(random_case);
  return runner.run(argc, argv);
}
