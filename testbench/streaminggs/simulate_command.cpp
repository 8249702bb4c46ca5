// streaminggs simulate SCENE --out DIR
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "algorithm/image/image_io.h"
#include "algorithm/image/quality.h"
#include "algorithm/input_error.h"
#include "algorithm/output_file.h"
#include "algorithm/render/reference_renderer.h"
#include "modules/config/strict_json.h"
#include "modules/filter_cost.h"
#include "testbench/streaminggs/commands.h"
#include "testbench/streaminggs/config_arguments.h"
#include "testbench/streaminggs/packed_config.h"
#include "testbench/streaminggs/prepared_scene.h"
#include "testbench/streaminggs/provenance.h"
#include "testbench/streaminggs/report.h"
#include "testbench/streaminggs/scene_arguments.h"

namespace sgs {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct Arguments : SceneArguments, ConfigArguments {
  std::string out;
  std::string vcd;
  std::string dram_trace;
  std::string timing = "accurate";
  double stalls = 0;
  std::uint64_t seed = 1;
  bool print_config = false;
  std::string command;  // the whole command line
};

double seconds_since(std::chrono::steady_clock::time_point began) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
}

ViewFacts simulate_view(const PreparedScene& prepared, int number, const Camera& camera,
                        const AcceleratorConfig& config, const RunOptions& options) {
  ViewFacts facts;
  facts.scene = prepared.name();
  facts.view = number;
  facts.gaussians = prepared.gaussians();
  facts.dropped_invalid = prepared.dropped_invalid();
  facts.frame_format = config.framebuffer;

  const FrameJob job = prepared.job(camera);
  facts.layout = job.layout;
  facts.image_hash = fnv1a64(prepared.image().bytes);

  const auto reference_of = [&](const ActivatedCloud& cloud) {
    return render_reference(job.view, cloud, job.background).image;
  };
  facts.decoded_reference = reference_of(prepared.decoded());
  facts.reference =
      prepared.original() != nullptr ? reference_of(*prepared.original()) : facts.decoded_reference;
  facts.golden = prepared.golden(job);

  facts.run = run_frame(config, job, prepared.image(), options);
  facts.equals_golden =
      facts.run.frame == encode_frame(config.framebuffer, facts.golden.frame.image);
  facts.frame = decode_frame(config.framebuffer, camera.width, camera.height, facts.run.frame);
  return facts;
}

// A scene's name may be any bytes.
std::string text_of(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void write_text(const fs::path& path, const std::string& text) {
  write_whole_file(path.string(), text.data(), text.size());
}

void write_view(const fs::path& folder, const ViewFacts& facts, const Json& report) {
  fs::create_directories(folder);
  write_image((folder / "frame.exr").string(), facts.frame);
  write_image((folder / "frame.png").string(), facts.frame);
  write_image((folder / "reference.exr").string(), facts.reference);
  write_image((folder / "reference.png").string(), facts.reference);
  write_image((folder / "error.png").string(), error_image(facts.frame, facts.reference));
  write_text(folder / "report.json", text_of(report));
}

Json list_choices(const std::vector<AutoChoice>& chosen) {
  Json list = Json::array();
  for (const AutoChoice& choice : chosen) {
    list.push_back({{"key", choice.key}, {"value", choice.value}, {"why", choice.why}});
  }
  return list;
}

PreparedScene prepare(std::optional<PackedScene> packed, Scene scene, const Arguments& arguments,
                      const AcceleratorConfig& config) {
  if (packed) return {std::move(*packed), arguments.scene, config};
  const std::vector<Camera> weighing = arguments.weighing_cameras(scene.cameras);
  return {std::move(scene), config, weighing};
}

int run(const Arguments& arguments) {
  const auto began = std::chrono::steady_clock::now();
  std::vector<AutoChoice> chosen;
  AcceleratorConfig config = arguments.given_config();
  std::optional<PackedScene> packed = arguments.load_packed();
  if (packed) adopt(*packed, arguments.scene, config, chosen);
  resolve(config, chosen);
  if (arguments.print_config) {
    // Only this key waits for the scene.
    if (config.hfu.cost == FilterCost::kCounted) {
      resolve_filter_cost(
          config, packed ? packed->image.layout.sh_degree() : arguments.load().cloud.sh_degree);
    }
    fmt::print("{}\n", config_to_json(config));
    return 0;
  }
  if (arguments.out.empty()) throw InputError("--out: expected a folder for pictures and reports");
  const bool one_view_only = !arguments.vcd.empty() || !arguments.dram_trace.empty();
  if (one_view_only && arguments.view == "all") {
    throw InputError("--vcd, --dram-trace: one file holds one view; expected --view with a number");
  }
  Scene scene;
  if (!packed) scene = arguments.load();
  const int sh_degree = packed ? packed->image.layout.sh_degree() : scene.cloud.sh_degree;
  for (const AutoChoice& cost : resolve_filter_cost(config, sh_degree)) chosen.push_back(cost);
  const auto views = arguments.cameras(scene.cameras);
  const PreparedScene prepared = prepare(std::move(packed), std::move(scene), arguments, config);

  const RunOptions options{arguments.timing == "fast" ? TimingMode::kFast : TimingMode::kAccurate,
                           arguments.vcd, arguments.dram_trace, arguments.stalls, arguments.seed};
  const Json resolved = Json::parse(config_to_json(config));
  Json all;
  all["schema_version"] = 1;
  all["config"] = resolved;
  bool equal = true;
  print_table_head();
  for (const auto& [number, camera] : views) {
    const ViewFacts facts = simulate_view(prepared, number, camera, config, options);
    Json report = view_report(facts, config);
    report["config"] = resolved;
    report["chosen"] = list_choices(chosen);
    report["host"]["wall_s"] = seconds_since(began);
    report["host"]["peak_rss_bytes"] = peak_rss_bytes();
    report["provenance"] = {{"version", SGS_VERSION},
                            {"commit", SGS_COMMIT},
                            {"memory_image_fnv1a64", fmt::format("{:016x}", facts.image_hash)},
                            {"timing", arguments.timing},
                            {"seed", arguments.seed},
                            {"command", arguments.command}};
    write_view(fs::path(arguments.out) / fmt::format("view_{}", number), facts, report);
    print_table_line(report);
    std::fflush(stdout);
    equal = equal && facts.equals_golden;
    all["views"].push_back(std::move(report));
  }
  write_text(fs::path(arguments.out) / "report.json", text_of(all));
  for (const auto& report : all["views"]) print_details(report);
  if (!equal) fmt::print("\nthe frame differs from the streaming renderer's\n");
  return equal ? 0 : 1;
}

}  // namespace

SubCommand add_simulate_command(CLI::App& app) {
  auto arguments = std::make_shared<Arguments>();
  arguments->add_scene_to(app);
  arguments->add_views_to(app);
  arguments->add_weighing_to(app);
  arguments->add_config_to(app);
  app.add_option("--out", arguments->out, "folder for pictures and reports");
  app.add_option("--vcd", arguments->vcd, "write a waveform");
  app.add_option("--dram-trace", arguments->dram_trace,
                 "write every DRAM command; tb_dram --check verifies it");
  app.add_option("--timing", arguments->timing, "memory protocol: four-phase, or annotated delays")
      ->check(CLI::IsMember({"accurate", "fast"}))
      ->capture_default_str();
  app.add_option("--stalls", arguments->stalls,
                 "probability of a random stall at each side of each FIFO, for tests")
      ->check(CLI::Range(0.0, 1.0));
  app.add_option("--seed", arguments->seed, "of the random stalls")->capture_default_str();
  app.add_flag("--print-config", arguments->print_config, "show the resolved configuration");
  return [arguments] {
    arguments->command = command_line();
    return run(*arguments);
  };
}

}  // namespace sgs
