// The rendering unit in Verilog beside the one in SystemC and the blending of a group, on splats of
// frames: every bit of the pixels, and the cycles of the frame.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "algorithm/dataset/view_cameras.h"
#include "algorithm/render/blend_pass.h"
#include "algorithm/splat/activate.h"
#include "modules/streaminggs/rendering/rendering_unit.h"
#include "testbench/builtin/builtin_scene.h"
#include "testbench/builtin/open_scene.h"
#include "testbench/units/job_memory.h"
#include "testbench/units/random_scene.h"
#include "tests/modules/clocked/comparison.h"
#include "tests/modules/streaminggs/rtl/rtl_rendering.h"
#include "tests/support/shared_inputs.h"

namespace sgs::test {
namespace {

constexpr PixelSize kGroup = square_of(96);
constexpr std::uint64_t kFirstToken = 2;  // put into the FIFO in the cycle before
constexpr double kMostApart = 16;         // cycles a group, of pipelines that fill

// The unit as it is in Verilog, spans as late as there: 2 and 6 cycles behind the schedule.
RenderingConfig config_of_verilog() {
  RenderingConfig config;
  config.cluster_lanes = 56;
  config.begin_lanes = 11;
  config.span_lanes = 10;
  config.span_slots = 48;
  config.pixel_buffers = 1;
  config.state_loop_cycles = 9;
  config.depth_cycles = 47;
  config.begin_depth_cycles = 79;
  config.span_depth_cycles = 45;
  config.drain_depth_cycles = 10;
  return config;
}

// What came to rendering in a frame: a group's splats, front to back, until it is finished.
struct Recording {
  StreamingJob job;
  std::vector<std::vector<Splat>> splats;  // [group]
  RenderResult pixels;                     // over black
};

Recording record(const Camera& camera, const ActivatedCloud& cloud) {
  const View<float> view = make_view<float>(camera);
  Recording out;
  out.job = tb::frame_job(view.width, view.height, kGroup, FrameFormat::kRgb8, 0);
  out.splats.resize(out.job.groups.size());
  const int columns = (view.width + kGroup.width - 1) / kGroup.width;
  const auto keep = [&](GroupState& group, const Splat& splat) {
    const PixelRect& px = group.pixels();
    out.splats[static_cast<std::size_t>(px.y0 / kGroup.height * columns + px.x0 / kGroup.width)]
        .push_back(splat);
    group.blend(splat);
  };
  const std::vector<GroupState> groups = blend_scene(view, cloud, keep, kGroup);
  out.pixels.image = Image(view.width, view.height);
  out.pixels.transmittance.resize(out.pixels.image.pixels.size());
  out.pixels.contributors.resize(out.pixels.image.pixels.size());
  for (const GroupState& group : groups) group.store(glm::vec3(0.0F), out.pixels);
  return out;
}

// Only every `step`th group.
void thin_out(Recording& recording, std::size_t step) {
  std::vector<PixelRect> groups;
  std::vector<std::vector<Splat>> splats;
  for (std::size_t g = 0; g < recording.splats.size(); g += step) {
    groups.push_back(recording.job.groups[g]);
    splats.push_back(recording.splats[g]);
  }
  recording.job.groups = groups;
  recording.splats = splats;
}

struct Listener : sc_core::sc_module, FinishGroupIf {
  explicit Listener(const sc_core::sc_module_name& name) : sc_module(name) {}
  void finish(std::uint32_t, std::uint32_t) override {}
};

// What of the unit's frame is compared.
enum Figure : std::uint64_t { kDrained, kBlends, kHidden };

void run_unit(tb::Case& test, Takings& taken, const Recording& recording) {
  tb::BenchConfig with;
  with.memory_bytes = tb::memory_bytes(recording.job);
  with.write_latency_cycles = 0;
  tb::UnitBench bench(test, with);
  UnitContext context = bench.context(recording.job);
  context.built_for.group = kGroup;
  Listener listener("listener");
  RenderingUnit unit("rendering", config_of_verilog(), Arrival::kByToken, context,
                     [&](std::uint32_t) {
                       taken.push_back({bench.clock().now_cycles(), kDrained});
                     });
  unit.finish(listener);
  constexpr std::uint32_t kEntries = 20;
  auto& input = bench.add_fifo<SplatToken>("splats", kEntries, 1);
  unit.splats(input);
  bench.add_unit(unit);
  std::vector<SplatToken> tokens;
  for (std::uint32_t g = 0; g < recording.splats.size(); ++g) {
    for (const Splat& splat : recording.splats[g]) tokens.push_back({splat, g, 0, Mark::kNone});
    tokens.push_back({{}, g, 0, Mark::kEndOfGroup});
  }
  add_source(bench, "source", tokens, {}, input);
  bench.run();
  taken.push_back({unit.schedule_counters().subtile_blends, kBlends});
  taken.push_back({unit.counters().splats_hidden + unit.counters().splats_saturated, kHidden});
}

// The unit's port splits rows of pixels; each part but the first of a group's last row takes a
// cycle more.
std::uint64_t port_cycles(const StreamingJob& job) {
  const std::uint64_t at_once = MemoryPortConfig{}.max_transaction_bytes;
  std::uint64_t cycles = 0;
  for (const PixelRect& px : job.groups) {
    const std::uint64_t first = job.pixel_address(px.x0, px.y1 - 1);
    const std::uint64_t last =
        job.pixel_address(px.x1 - 1, px.y1 - 1) + pixel_bytes(job.frame_format) - 1;
    cycles += last / at_once - first / at_once;
  }
  return cycles;
}

void check(const std::string& name, const Recording& recording) {
  const RtlFrame rtl = render_in_verilog(recording.job.groups, recording.splats, kFirstToken);
  std::size_t differ = 0, pixels = 0, splats = 0;
  for (std::size_t g = 0; g < rtl.groups.size(); ++g) {
    const PixelRect& px = recording.job.groups[g];
    splats += recording.splats[g].size();
    for (int y = px.y0; y < px.y1; ++y) {
      for (int x = px.x0; x < px.x1; ++x) {
        const RtlPixel& got =
            rtl.groups[g].pixels[static_cast<std::size_t>((y - px.y0) * px.width() + x - px.x0)];
        const auto at = static_cast<std::size_t>(y) * recording.job.view.width + x;
        const glm::vec3& rgb = recording.pixels.image.pixels[at];
        const auto bits = [](float v) { return __builtin_bit_cast(std::uint32_t, v); };
        ++pixels;
        const bool same = got.red == bits(rgb.x) && got.green == bits(rgb.y) &&
                          got.blue == bits(rgb.z) &&
                          got.light == bits(recording.pixels.transmittance[at]);
        differ += same ? 0 : 1;
      }
    }
  }
  const Takings unit =
      takings_of_unit(1, [&](tb::Case& test, Takings& taken) { run_unit(test, taken, recording); });
  REQUIRE(unit.size() == 3);
  const std::uint64_t drained = rtl.groups.back().drained + port_cycles(recording.job);
  const auto cycles = static_cast<double>(unit[0].cycle);
  const double apart = static_cast<double>(drained) - cycles;
  fmt::print(
      "{:9} {:2} groups, {:6} splats, {:6} pixels; cycles {:7} in SystemC, {:7} in Verilog with {} "
      "of the port: {:+} ({:+.3f} %); blends {} and {}; hidden {} and {}\n",
      name, rtl.groups.size(), splats, pixels, unit[0].cycle, drained, port_cycles(recording.job),
      apart, 100 * apart / cycles, unit[1].cycle, rtl.blends, unit[2].cycle, rtl.hidden);
  CHECK(pixels > 0);
  CHECK(differ == 0);
  CHECK(std::abs(apart) <= kMostApart * static_cast<double>(rtl.groups.size()));
}

// Every ninth of the 28 groups of a frame.
void check_frame(const std::string& name, const Camera& camera, const GaussianCloud& cloud) {
  Recording recording = record(scaled_to(camera, 640, 360), activate(cloud));
  thin_out(recording, 9);
  check(name, recording);
}

void check_shared(const std::string& name) {
  const ViewCameras views = read_view_cameras(shared_path("cameras/" + name + ".json"));
  check_frame(name, views.cameras.front(), open_scene(shared_scene(name)).cloud);
}

}  // namespace

TEST_CASE("rendering unit in Verilog: a small frame") {
  const BuiltinScene scene = make_builtin_scene("builtin:outdoor?n=600");
  check("outdoor", record(scaled_to(scene.cameras.front(), 110, 62), activate(scene.cloud)));
}
TEST_CASE("rendering unit in Verilog: object", "[nightly]") {
  const BuiltinScene scene = make_builtin_scene("builtin:object");
  check_frame("object", scene.cameras.front(), scene.cloud);
}
TEST_CASE("rendering unit in Verilog: truck", "[shared][nightly]") { check_shared("truck"); }
TEST_CASE("rendering unit in Verilog: yard", "[shared][nightly]") { check_shared("yard"); }
TEST_CASE("rendering unit in Verilog: platform", "[shared][nightly]") { check_shared("platform"); }

}  // namespace sgs::test
