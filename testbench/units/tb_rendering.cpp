// Rendering unit alone: sorted splats in, a frame buffer in memory out. Checked against GroupState;
// times: tests/modules/streaminggs/clocked.
#include "testbench/units/job_memory.h"
#include "testbench/units/random_scene.h"
#include "testbench/units/rendering_run.h"

namespace sgs::tb {
namespace {

RenderingPlan make_plan(int width_px, int height_px, const PixelSize& group, FrameFormat format) {
  RenderingPlan plan;
  plan.group = group;
  plan.job = frame_job(width_px, height_px, group, format, 0);
  plan.groups.resize(plan.job.groups.size());
  plan.input_entries = 4096;
  plan.config.depth_cycles = 24;
  plan.config.state_loop_cycles = 5;
  plan.config.begin_depth_cycles = 30;
  plan.config.span_depth_cycles = 20;
  plan.config.drain_depth_cycles = 7;
  return plan;
}

std::vector<Splat> random_visit(std::mt19937_64& random, const RenderingPlan& plan,
                                std::size_t group, std::size_t splats, float opacity) {
  std::vector<Splat> visit;
  for (std::size_t i = 0; i < splats; ++i) {
    visit.push_back(random_splat(random, plan.job.groups[group], plan.job,
                                 static_cast<std::uint32_t>(i), opacity));
  }
  return visit;
}

// A splat that hides all of a group: flat, opaque, as wide as the frame.
Splat curtain(const RenderingPlan& plan) {
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
  RenderingPlan plan = make_plan(
      1 + static_cast<int>(random() % 150), 1 + static_cast<int>(random() % 90),
      {4 * (1 + static_cast<int>(random() % 24)), 4 * (1 + static_cast<int>(random() % 24))},
      random() % 2 == 0 ? FrameFormat::kRgb8 : FrameFormat::kRgb32f);
  plan.inputs = 1 + static_cast<std::uint32_t>(random() % 3);
  plan.config.clusters = 1 + static_cast<std::uint32_t>(random() % 6);
  plan.config.pixel_buffers = 1 + static_cast<std::uint32_t>(random() % 2);
  plan.config.depth_cycles = 1 + static_cast<std::uint32_t>(random() % 20);
  plan.config.drain_pixels_per_cycle = 1 + static_cast<std::uint32_t>(random() % 16);
  plan.config.saturation_feedback = random() % 2 == 0;
  plan.config.ellipse_test = random() % 2 == 0;
  plan.config.begin_lanes = 1 + static_cast<std::uint32_t>(random() % 100);
  plan.config.span_lanes = 1 + static_cast<std::uint32_t>(random() % 256);
  plan.config.cluster_lanes = 100 + static_cast<std::uint32_t>(random() % 500);
  plan.config.cluster_queue_entries = 1 + static_cast<std::uint32_t>(random() % 8);
  plan.config.state_loop_cycles = 1 + static_cast<std::uint32_t>(random() % 12);
  plan.config.begin_depth_cycles = 1 + static_cast<std::uint32_t>(random() % 60);
  plan.config.span_depth_cycles = 1 + static_cast<std::uint32_t>(random() % 60);
  plan.config.span_slots = 1 + static_cast<std::uint32_t>(random() % 12);
  plan.config.drain_depth_cycles = 1 + static_cast<std::uint32_t>(random() % 20);
  plan.config.precision = static_cast<BlendPrecision>(random() % 3);
  if (plan.config.cluster_interval_cycles() > 1 && random() % 2 == 0) {
    plan.config.pixel_ports = 1;
  }
  plan.arrival = random() % 2 == 0 ? Arrival::kByVisit : Arrival::kByToken;
  const BenchConfig bench = random_bench(random, memory_bytes(plan.job));
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

}  // namespace
}  // namespace sgs::tb

int sc_main(int argc, char* argv[]) {
  using namespace sgs;
  using namespace sgs::tb;
  CaseRunner runner("tb_rendering", "Rendering unit alone, against the blending of one group");
  // A frame in groups of a square, with what `fill` puts into the plan.
  const auto add = [&](const char* name, int width_px, int height_px, int side_px, auto fill) {
    runner.add_directed(name, [=](Case& test) {
      RenderingPlan plan = make_plan(width_px, height_px, square_of(side_px), FrameFormat::kRgb32f);
      fill(plan, test.random);
      run_plan(test, still_bench(memory_bytes(plan.job)), plan);
    });
  };
  using Random = std::mt19937_64;
  const auto splats = [](std::size_t count) {
    return [=](RenderingPlan& plan, Random& random) {
      for (std::size_t g = 0; g < plan.groups.size(); ++g) {
        plan.groups[g].push_back(random_visit(random, plan, g, count, 1.0F));
      }
    };
  };
  add("end-of-group marks only", 64, 48, 16, [](RenderingPlan&, Random&) {});
  add("empty visits", 64, 48, 32, splats(0));
  add("one splat", 16, 16, 16, splats(1));
  add("1x1 frame", 1, 1, 64, splats(5));
  add("groups cut by the frame's edge", 70, 33, 32, splats(20));
  add("8-bit pixels", 70, 33, 32, [=](RenderingPlan& plan, Random& random) {
    plan.job = frame_job(70, 33, plan.group, FrameFormat::kRgb8, 0);
    splats(20)(plan, random);
  });
  add("two pixel buffers", 128, 64, 32, [=](RenderingPlan& plan, Random& random) {
    plan.config.pixel_buffers = 2;
    splats(50)(plan, random);
  });
  add("every token from another FIFO", 64, 48, 32, [=](RenderingPlan& plan, Random& random) {
    plan.arrival = Arrival::kByToken;
    plan.inputs = 4;
    splats(30)(plan, random);
  });
  add("saturated group", 64, 32, 32, [](RenderingPlan& plan, Random& random) {
    // T falls to 0.01 and 0.0001; the next would bring it below: three splats finish every pixel.
    plan.groups[0].push_back(std::vector<Splat>(10, curtain(plan)));
    plan.groups[0].push_back(random_visit(random, plan, 0, 10, 1.0F));
    plan.groups[1].push_back(random_visit(random, plan, 1, 10, 0.5F));
  });
  add("splats behind finished sub-tiles of an unfinished group", 32, 32, 32,
      [](RenderingPlan& plan, Random&) {
        Splat left = curtain(plan);
        left.footprint.x1 = 4;
        // The last take a cycle for nothing.
        plan.groups[0].push_back(std::vector<Splat>(10, left));
      });
  add("splats too faint to be blended", 32, 32, 32, [](RenderingPlan& plan, Random& random) {
    plan.groups[0].push_back(random_visit(random, plan, 0, 10, 0.001F));
  });
  runner.set_random(random_case);
  return runner.run(argc, argv);
}
