// streaminggs gpu SCENE
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "algorithm/files/output_file.h"
#include "algorithm/splat/activate.h"
#include "modules/config/strict_json.h"
#include "testbench/command_line/output_name.h"
#include "testbench/gpu/gpu_model.h"
#include "testbench/streaminggs/commands.h"
#include "testbench/streaminggs/report/numbers.h"
#include "testbench/streaminggs/report/provenance.h"
#include "testbench/streaminggs/run/scene_arguments.h"

namespace sgs {
namespace {

using Json = nlohmann::ordered_json;

struct GpuArguments : SceneArguments {
  std::string gpu, out;
  std::vector<std::string> overrides;

  GpuConfig config() const {
    ConfigDocument document;
    if (!gpu.empty()) document.add_file(gpu);
    for (const std::string& assignment : overrides) document.add_override(assignment);
    GpuConfig config;
    document.read_into(config);
    return config;
  }
};

Json in_json(const GpuStage& s) {
  return {{"name", s.name},
          {"warp_instructions", s.instructions},
          {"scene_bytes", s.scene_bytes},
          {"intermediate_bytes", s.intermediate_bytes},
          {"frame_bytes", s.frame_bytes},
          {"seconds", s.seconds},
          {"bound_by", s.bound_by_bytes ? "bytes" : "instructions"}};
}

Json in_json(const RasterWork& w) {
  return {{"gaussians", w.gaussians},
          {"in_front", w.in_front},
          {"listed", w.listed},
          {"pairs", w.pairs},
          {"tiles", w.tiles},
          {"pixels", w.pixels},
          {"entries_fetched", w.entries_fetched},
          {"warp_entries", w.warp_entries},
          {"warp_blends", w.warp_blends},
          {"blends", w.blends}};
}

// Share of the lanes that blend, in warps that walk lists, 0 to 1.
double used_lanes(const RasterWork& w) {
  return w.warp_entries == 0
             ? 0
             : static_cast<double>(w.blends) / (32.0 * static_cast<double>(w.warp_entries));
}

void print_head(const GpuConfig& c) {
  fmt::print(
      "modelled, not simulated: {:g} MHz, {} instructions of warps a cycle, {:g} GB/s, of which it "
      "gets {:g} and {:g}; single precision; joules are {:g} W times modelled time\n",
      c.clock_mhz, c.schedulers, c.bandwidth_gb_s, c.issue_share, c.bandwidth_share, c.watts);
}

void print_mean(const std::vector<GpuFrame>& frames) {
  const auto mean = [&](auto of) {
    double sum = 0;
    for (const GpuFrame& frame : frames) sum += of(frame);
    return sum / static_cast<double>(frames.size());
  };
  const double seconds = mean([](const GpuFrame& f) { return f.seconds; });
  fmt::print(
      "mean of {} views, modelled: {:.2f} ms, {:.2f} frames a second, {:.1f} MB, {:.1f} mJ\n",
      frames.size(), 1e3 * seconds, 1 / seconds,
      mean([](const GpuFrame& f) { return f.bytes(); }) / 1e6,
      1e3 * mean([](const GpuFrame& f) { return f.joules; }));
}

void print_view(int number, const RasterWork& work, const GpuFrame& frame) {
  fmt::print("view {}: {} of {} Gaussians listed, {} pairs, {:.1f} % of lanes blend\n", number,
             grouped(work.listed), grouped(work.gaussians), grouped(work.pairs),
             100 * used_lanes(work));
  if (work.blends == 0) fmt::print("view {}: no Gaussian contributes to the picture\n", number);
  fmt::print("  {:<12} {:>9} {:>12} {:>14} {:>9}  {}\n", "stage", "ms", "scene MB",
             "intermediate MB", "pixels MB", "bound by");
  for (const GpuStage& s : frame.stages) {
    fmt::print("  {:<12} {:>9.3f} {:>12.2f} {:>14.2f} {:>9.2f}  {}\n", s.name, 1e3 * s.seconds,
               s.scene_bytes / 1e6, s.intermediate_bytes / 1e6, s.frame_bytes / 1e6,
               s.bound_by_bytes ? "bytes" : "instructions");
  }
  const double all = frame.bytes();
  fmt::print(
      "  modelled: {:.2f} ms, {:.2f} frames a second, {:.1f} MB, {:.1f} mJ; of the bytes "
      "projection {:.0f} %, sorting {:.0f} %, rendering {:.0f} %, intermediate {:.0f} %\n",
      1e3 * frame.seconds, 1 / frame.seconds, all / 1e6, 1e3 * frame.joules,
      100 * frame.bytes_of(GpuPart::kProjection) / all,
      100 * frame.bytes_of(GpuPart::kSorting) / all,
      100 * frame.bytes_of(GpuPart::kRendering) / all, 100 * frame.intermediate_bytes() / all);
}

int run(const GpuArguments& arguments) {
  GpuConfig config = arguments.config();
  if (!arguments.out.empty()) check_output_name(arguments.out, ".json");
  OutputPlan plan;
  arguments.add_inputs_to(plan);
  plan.add_input(arguments.gpu);
  if (!arguments.out.empty()) plan.add_output(arguments.out);
  plan.check();
  const Scene scene = arguments.load();
  const ActivatedCloud cloud = activate(scene.cloud);
  Json views = Json::array();
  std::vector<GpuFrame> frames;
  const auto cameras = arguments.cameras(scene.cameras);
  print_head(config);
  for (const auto& [number, camera] : cameras) {
    const RasterWork work = count_raster_work(make_view<float>(camera), cloud);
    const GpuFrame frame = model_gpu(work, config);
    print_view(number, work, frame);
    frames.push_back(frame);
    Json stages = Json::array();
    for (const GpuStage& stage : frame.stages) stages.push_back(in_json(stage));
    views.push_back({{"view", number},
                     {"modelled", true},
                     {"work", in_json(work)},
                     {"stages", stages},
                     {"seconds", frame.seconds},
                     {"joules", frame.joules}});
  }
  if (frames.size() > 1) print_mean(frames);
  if (arguments.out.empty()) return 0;
  const Json report = {{"scene", arguments.scene},
                       {"command", command_line()},
                       {"precision", "fp32"},
                       {"gpu", Json::parse(config_to_json(config))},
                       {"views", views}};
  const std::string text = report.dump(2) + '\n';
  write_whole_file(arguments.out, text.data(), text.size());
  return 0;
}

}  // namespace

SubCommand add_gpu_command(CommandLine& line, const Kinds&) {
  auto arguments = std::make_shared<GpuArguments>();
  arguments->add_scene_to(line, kUnpackedSceneForms);
  arguments->add_views_to(line);
  line.file("--gpu", arguments->gpu, "JSON file with keys of the model; otherwise Orin NX");
  line.texts("--set", arguments->overrides, "key=value, over it; may be repeated");
  line.set_keys([] {
    ConfigDocument document;
    document.add_text(config_to_json(GpuConfig()), "the defaults");
    std::vector<std::string> keys;
    for (const ConfigOrigin& value : document.origins()) keys.push_back(value.path);
    return keys;
  });
  line.file("--out", arguments->out, "file to write the same to: .json");
  return [arguments] { return run(*arguments); };
}

}  // namespace sgs
