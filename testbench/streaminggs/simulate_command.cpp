// streaminggs simulate SCENE --out DIR
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "algorithm/image/image_io.h"
#include "algorithm/input_error.h"
#include "algorithm/output_file.h"
#include "algorithm/output_plan.h"
#include "testbench/command_line/config_source.h"
#include "testbench/command_line/version.h"
#include "testbench/streaminggs/commands.h"
#include "testbench/streaminggs/error_maps.h"
#include "testbench/streaminggs/provenance.h"
#include "testbench/streaminggs/report.h"
#include "testbench/streaminggs/scene_arguments.h"
#include "testbench/streaminggs/terminal.h"

namespace sgs {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct Arguments : SceneArguments {
  ConfigSource config;
  std::string out;
  std::string technology = SGS_TECHNOLOGY;
  RunOptions run;
  bool print_config = false;
  std::string command;  // the whole command line
};

double seconds_since(std::chrono::steady_clock::time_point began) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
}

// A scene's name may be any bytes.
std::string text_of(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void write_text(const fs::path& path, const std::string& text) {
  write_whole_file(path.string(), text.data(), text.size());
}

fs::path view_folder(const fs::path& out, int view) { return out / fmt::format("view_{}", view); }

constexpr const char* kViewFiles[] = {"frame.exr", "frame.png", "reference.exr", "reference.png",
                                      "report.json"};

void write_view(const fs::path& folder, const ViewResult& view, const Json& report) {
  write_image((folder / "frame.exr").string(), view.frame);
  write_image((folder / "frame.png").string(), view.frame);
  write_image((folder / "reference.exr").string(), view.reference);
  write_image((folder / "reference.png").string(), view.reference);
  write_error_maps(folder, view);
  write_text(folder / "report.json", text_of(report));
}

Json list_choices(const std::vector<AutoChoice>& chosen) {
  Json list = Json::array();
  for (const AutoChoice& choice : chosen) {
    list.push_back({{"key", choice.key}, {"value", choice.value}, {"why", choice.why}});
  }
  return list;
}

// Refuses outputs that have no place, or would take that of an input, before the work begins.
void check_places(const Arguments& arguments, const RunConfig& config, const fs::path& out,
                  const std::vector<std::pair<int, Camera>>& views) {
  OutputPlan plan;
  arguments.add_inputs_to(plan);
  plan.add_input(arguments.config.path());
  plan.add_input(arguments.technology);
  plan.add_input(config.dram.memspec);
  for (const std::string& file : {arguments.run.vcd_path, arguments.run.dram_trace_path}) {
    if (!file.empty()) plan.add_output(file);
  }
  plan.add_output((out / "report.json").string());
  for (const auto& [number, camera] : views) {
    for (const char* file : kViewFiles) {
      plan.add_output((view_folder(out, number) / file).string());
    }
    for (const char* file : kErrorMapFiles) {
      plan.add_output((view_folder(out, number) / file).string());
    }
  }
  plan.check();
}

int run(const Arguments& arguments, const Kinds& kinds) {
  const auto began = std::chrono::steady_clock::now();
  RunConfig config = read_run_config(arguments.config.document(), kinds);
  std::optional<PackedScene> packed = arguments.load_packed();
  if (packed) {
    resolve(config, *packed, arguments.scene);
  } else {
    resolve(config);
  }
  if (arguments.print_config) {
    if (packed) {
      adapt(config, *packed);
    } else {
      adapt(config, arguments.load());
    }
    fmt::print("{}\n", to_json(config));
    return 0;
  }
  const fs::path out = arguments.out.empty() ? arguments.default_out() : arguments.out;
  const RunOptions& options = arguments.run;
  const bool one_view_only = !options.vcd_path.empty() || !options.dram_trace_path.empty();
  if (one_view_only && arguments.view.find_first_not_of("0123456789") != std::string::npos) {
    throw InputError(
        "--vcd, --dram-trace: one file holds one view; expected --view with one number");
  }
  const Technology technology = load_technology(arguments.technology);
  Scene scene;
  if (!packed) scene = arguments.load();
  const auto views = arguments.cameras(scene.cameras);
  check_places(arguments, config, out, views);
  PreparedScene prepared;
  if (packed) {
    prepared = prepare(std::move(*packed), arguments.scene, config);
  } else {
    const std::vector<Camera> weighing = arguments.weighing_cameras(scene.cameras);
    prepared = prepare(std::move(scene), config, weighing);
  }

  const Json resolved = Json::parse(to_json(config));
  Json all;
  all["schema_version"] = 2;
  all["config"] = resolved;
  std::vector<ViewResult> results;
  bool equal = true;
  print_table_head();
  for (const auto& [number, camera] : views) {
    results.push_back(simulate_view(prepared, number, camera, config, technology, options));
    const ViewResult& view = results.back();
    Json report = view_report(view, prepared);
    report["config"] = resolved;
    report["chosen"] = list_choices(config.chosen);
    report["host"]["wall_s"] = seconds_since(began);
    report["host"]["peak_rss_bytes"] = peak_rss_bytes();
    report["provenance"] = {{"version", version()},
                            {"commit", commit()},
                            {"memory_image_fnv1a64", fmt::format("{:016x}", view.image_hash)},
                            {"technology", technology.name},
                            {"seed", options.build.stalls.seed},
                            {"command", arguments.command}};
    write_view(view_folder(out, number), view, report);
    print_table_line(view);
    std::fflush(stdout);
    equal = equal && view.equals_golden;
    all["views"].push_back(std::move(report));
  }
  write_text(out / "report.json", text_of(all));
  for (const ViewResult& view : results) print_details(view);
  print_machine(results.front(), config.chosen, technology.name);
  if (!equal) fmt::print("\nthe frame differs from the golden renderer's\n");
  return equal ? 0 : 1;
}

}  // namespace

SubCommand add_simulate_command(CLI::App& app, const Kinds& kinds) {
  auto arguments = std::make_shared<Arguments>();
  arguments->add_scene_to(app);
  arguments->add_views_to(app);
  arguments->add_weighing_to(app);
  arguments->config.config = kinds.front().name;
  arguments->config.add_to(app);
  app.add_option("--out", arguments->out,
                 "folder for pictures and reports; out/ and the scene's name if not given");
  app.add_option("--vcd", arguments->run.vcd_path, "write a waveform");
  app.add_option("--dram-trace", arguments->run.dram_trace_path,
                 "write every DRAM command; tb_dram --check verifies it");
  app.add_option("--technology", arguments->technology, "table of energy and area")
      ->capture_default_str();
  BuildOptions& build = arguments->run.build;
  app.add_option("--stalls", build.stalls.probability,
                 "probability of a random stall at each side of each FIFO, for tests")
      ->check(CLI::Range(0.0, 1.0));
  app.add_option("--seed", build.stalls.seed, "of the random stalls")->capture_default_str();
  app.add_option("--construction-order", build.construction_order,
                 "seed that shuffles the order in which units are made; changes no number");
  app.add_flag("--print-config", arguments->print_config, "show the resolved configuration");
  return [arguments, &kinds] {
    arguments->command = command_line();
    return run(*arguments, kinds);
  };
}

}  // namespace sgs
