// streaminggs simulate SCENE --out DIR
#include <fmt/format.h>
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "algorithm/image/image_io.h"
#include "algorithm/image/quality.h"
#include "algorithm/input_error.h"
#include "algorithm/output_file.h"
#include "algorithm/render/exact_renderer.h"
#include "algorithm/render/paper_renderer.h"
#include "algorithm/render/reference_renderer.h"
#include "algorithm/splat/activate.h"
#include "modules/accelerator.h"
#include "modules/auto_config.h"
#include "modules/config/strict_json.h"
#include "testbench/streaminggs/commands.h"
#include "testbench/streaminggs/report.h"
#include "testbench/streaminggs/scene_arguments.h"

namespace sgs {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct Arguments : SceneArguments {
  std::string config = "exact";
  std::vector<std::string> overrides;
  std::string out;
  std::string vcd;
  std::string timing = "accurate";
  double stalls = 0;
  std::uint64_t seed = 1;
  bool print_config = false;
};

// A preset's name, or a file.
std::string config_path(const std::string& config) {
  const fs::path preset = fs::path(SGS_SOURCE_DIR) / "testbench" / "configs" / (config + ".json");
  if (config.find_first_of("./") == std::string::npos && fs::exists(preset)) return preset.string();
  return config;
}

AcceleratorConfig read_config(const Arguments& arguments, std::vector<AutoChoice>& chosen) {
  ConfigDocument document;
  document.add_file(config_path(arguments.config));
  for (const std::string& assignment : arguments.overrides) document.add_override(assignment);
  AcceleratorConfig config;
  document.read_into(config);
  chosen = resolve_auto(config);
  config.validate();
  return config;
}

double seconds_since(std::chrono::steady_clock::time_point began) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
}

std::uint64_t peak_rss_bytes() {
  rusage self{}, children{};
  getrusage(RUSAGE_SELF, &self);
  getrusage(RUSAGE_CHILDREN, &children);
  constexpr std::uint64_t kKiB = 1024;
  return static_cast<std::uint64_t>(std::max(self.ru_maxrss, children.ru_maxrss)) * kKiB;
}

// A scene made ready for the accelerator: laid out for the configured order.
struct Prepared {
  Scene scene;
  ActivatedCloud cloud;
  VoxelGrid grid;  // paper order
  ChunkTree tree;  // exact order

  Prepared(Scene loaded, const AcceleratorConfig& config)
      : scene(std::move(loaded)), cloud(activate(scene.cloud)) {
    const Stored stored = config.store_invisible ? Stored::kAll : Stored::kVisible;
    if (config.ordering == Ordering::kExact) {
      tree = build_chunk_tree(cloud, config.chunk_gaussians, stored);
      return;
    }
    const float voxel_size =
        config.voxel_size > 0 ? static_cast<float>(config.voxel_size) : paper_voxel_size(cloud);
    grid = build_voxel_grid(cloud, voxel_size, stored);
  }

  MemoryImage image(const AcceleratorConfig& config, std::uint64_t frame_bytes) const {
    return config.ordering == Ordering::kExact
               ? build_memory_image(cloud, tree, spill_region_bytes(tree), frame_bytes)
               : build_memory_image(cloud, grid, spill_region_bytes(config, grid), frame_bytes);
  }

  StreamingResult golden(const FrameJob& job, const AcceleratorConfig& config) const {
    if (config.ordering == Ordering::kExact) {
      ExactOrderConfig order;
      order.group_px = job.group_px;
      order.merge_entries = config.merge.entries;
      order.on_overflow = config.merge.on_overflow;
      order.walk_queue_entries = config.vsu.queue_entries;
      order.background = job.background;
      return render_exact_order(job.view, cloud, tree, order);
    }
    PaperOrderConfig order;
    order.group_px = job.group_px;
    order.sample_step_voxels = static_cast<float>(config.vsu.sample_step_voxels);
    order.background = job.background;
    return render_paper_order(job.view, cloud, grid, order);
  }
};

FrameJob make_job(const Camera& camera, const AcceleratorConfig& config) {
  FrameJob job;
  job.view = make_view<float>(camera);
  job.frame_format = config.framebuffer;
  job.group_px = static_cast<int>(config.group_px);
  job.groups = pixel_groups(camera.width, camera.height, job.group_px);
  return job;
}

void check_capacity(const MemoryLayout& layout, const DramConfig& dram) {
  const std::uint64_t capacity = AddressMapping(dram, load_memspec(dram.memspec)).capacity_bytes();
  if (layout.total_bytes() > capacity) {
    throw InputError(
        fmt::format("dram: the scene and its frame take {} bytes, {} channels x {} ranks "
                    "hold {}",
                    layout.total_bytes(), dram.channels, dram.ranks, capacity));
  }
}

ViewFacts simulate_view(const Prepared& prepared, int number, const Camera& camera,
                        const AcceleratorConfig& config, const RunOptions& options) {
  ViewFacts facts;
  facts.scene = prepared.scene.name;
  facts.view = number;
  facts.gaussians = prepared.cloud.size();
  facts.dropped_invalid = prepared.scene.dropped_invalid;
  facts.frame_format = config.framebuffer;

  FrameJob job = make_job(camera, config);
  const std::uint64_t frame_bytes =
      std::uint64_t{pixel_bytes(config.framebuffer)} * camera.width * camera.height;
  const MemoryImage image = prepared.image(config, frame_bytes);
  check_capacity(image.layout, config.dram);
  job.layout = image.layout;
  facts.layout = image.layout;

  facts.reference = render_reference(job.view, prepared.cloud, job.background).image;
  facts.golden = prepared.golden(job, config);

  facts.run = run_frame(config, job, image, options);
  facts.equals_golden =
      facts.run.frame == encode_frame(config.framebuffer, facts.golden.frame.image);
  facts.frame = decode_frame(config.framebuffer, camera.width, camera.height, facts.run.frame);
  return facts;
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
  write_text(folder / "report.json", report.dump(2) + "\n");
}

Json list_choices(const std::vector<AutoChoice>& chosen) {
  Json list = Json::array();
  for (const AutoChoice& choice : chosen) {
    list.push_back({{"key", choice.key}, {"value", choice.value}, {"why", choice.why}});
  }
  return list;
}

int run(const Arguments& arguments) {
  std::vector<AutoChoice> chosen;
  const AcceleratorConfig config = read_config(arguments, chosen);
  if (arguments.print_config) {
    fmt::print("{}\n", config_to_json(config));
    return 0;
  }
  if (arguments.out.empty()) throw InputError("--out: expected a folder for pictures and reports");
  if (!arguments.vcd.empty() && arguments.view == "all") {
    throw InputError("--vcd: one file holds one view; expected --view with a number");
  }
  const auto began = std::chrono::steady_clock::now();
  Scene scene = arguments.load();
  const auto views = arguments.cameras(scene);
  const Prepared prepared(std::move(scene), config);

  const RunOptions options{arguments.timing == "fast" ? TimingMode::kFast : TimingMode::kAccurate,
                           arguments.vcd, arguments.stalls, arguments.seed};
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
    report["provenance"] = {
        {"version", SGS_VERSION}, {"timing", arguments.timing}, {"seed", arguments.seed}};
    write_view(fs::path(arguments.out) / fmt::format("view_{}", number), facts, report);
    print_table_line(report);
    std::fflush(stdout);
    equal = equal && facts.equals_golden;
    all["views"].push_back(std::move(report));
  }
  write_text(fs::path(arguments.out) / "report.json", all.dump(2) + "\n");
  for (const auto& report : all["views"]) print_details(report);
  if (!equal) fmt::print("\nthe frame differs from the streaming renderer's\n");
  return equal ? 0 : 1;
}

}  // namespace

SubCommand add_simulate_command(CLI::App& app) {
  auto arguments = std::make_shared<Arguments>();
  arguments->add_scene_to(app);
  arguments->add_views_to(app);
  app.add_option("--config", arguments->config, "preset or JSON file")->capture_default_str();
  app.add_option("--set", arguments->overrides, "key.path=value, over the configuration");
  app.add_option("--out", arguments->out, "folder for pictures and reports");
  app.add_option("--vcd", arguments->vcd, "write a waveform");
  app.add_option("--timing", arguments->timing, "memory protocol: four-phase, or annotated delays")
      ->check(CLI::IsMember({"accurate", "fast"}))
      ->capture_default_str();
  app.add_option("--stalls", arguments->stalls,
                 "probability of a random stall at each side of each FIFO, for tests")
      ->check(CLI::Range(0.0, 1.0));
  app.add_option("--seed", arguments->seed, "of the random stalls")->capture_default_str();
  app.add_flag("--print-config", arguments->print_config, "show the resolved configuration");
  return [arguments] { return run(*arguments); };
}

}  // namespace sgs
