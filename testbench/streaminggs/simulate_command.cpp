// streaminggs simulate SCENE --out DIR
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "algorithm/image/image_io.h"
#include "algorithm/input_error.h"
#include "algorithm/output_file.h"
#include "algorithm/output_plan.h"
#include "algorithm/output_set.h"
#include "testbench/command_line/config_source.h"
#include "testbench/command_line/option_checks.h"
#include "testbench/command_line/version.h"
#include "testbench/streaminggs/commands.h"
#include "testbench/streaminggs/error_maps.h"
#include "testbench/streaminggs/provenance.h"
#include "testbench/streaminggs/report.h"
#include "testbench/streaminggs/result_folder.h"
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

// All files of a view at once: no picture stands beside the report of another run.
void write_view(const fs::path& folder, const ViewResult& view, const Json& report) {
  OutputSet files;
  const auto add = [&](const std::string& file) -> OutputFile& {
    return files.add((folder / file).string());
  };
  write_image(add("frame.exr"), view.frame);
  write_image(add("frame.png"), view.frame);
  write_image(add("reference.exr"), view.reference);
  write_image(add("reference.png"), view.reference);
  add("report.json").write(text_of(report));
  std::set<std::string> old_maps(std::begin(kErrorMapFiles), std::end(kErrorMapFiles));
  for (const ErrorMap& map : error_maps(view)) {
    write_image(add(map.file), map.image);
    old_maps.erase(map.file);
  }
  files.commit();
  for (const std::string& map : old_maps) fs::remove(folder / map);
}

Json list_choices(const std::vector<AutoChoice>& chosen) {
  Json list = Json::array();
  for (const AutoChoice& choice : chosen) {
    list.push_back({{"key", choice.key}, {"value", choice.value}, {"why", choice.why}});
  }
  return list;
}

// Refuses outputs that have no place, or would take that of an input, before the work begins.
void check_places(const Arguments& arguments, const RunConfig& config, const ResultFolder& out,
                  const std::vector<std::pair<int, Camera>>& views) {
  OutputPlan plan;
  arguments.add_inputs_to(plan);
  plan.add_input(arguments.config.path());
  plan.add_input(arguments.technology);
  plan.add_input(config.dram.memspec);
  for (const std::string& file : {arguments.run.vcd_path, arguments.run.dram_trace_path}) {
    if (!file.empty()) plan.add_output(file);
  }
  plan.add_output(out.report().string());
  std::set<fs::path> files;
  for (const auto& [number, camera] : views) {
    const std::vector<fs::path> of_view = ResultFolder::files_of(out.view(number));
    files.insert(of_view.begin(), of_view.end());
  }
  // Those of an earlier run will be removed.
  const std::vector<fs::path> earlier = out.present();
  files.insert(earlier.begin(), earlier.end());
  for (const fs::path& file : files) plan.add_output(file.string());
  plan.check();
}

// What a command knows before its first frame.
struct Setting {
  RunConfig config;
  Technology technology;
  PreparedScene scene;
  Json resolved;  // the configuration
  std::chrono::steady_clock::time_point began;
};

Json full_report(const Arguments& arguments, const Setting& setting, const ViewResult& view) {
  Json report = view_report(view, setting.scene);
  report["config"] = setting.resolved;
  report["chosen"] = list_choices(setting.config.chosen);
  report["host"]["wall_s"] = seconds_since(setting.began);
  report["host"]["peak_rss_bytes"] = peak_rss_bytes();
  report["provenance"] = {{"version", version()},
                          {"commit", commit()},
                          {"memory_image_fnv1a64", fmt::format("{:016x}", view.image_hash)},
                          {"technology", setting.technology.name},
                          {"seed", arguments.run.build.stalls.seed},
                          {"command", arguments.command}};
  return report;
}

// Simulates the views one after the other and writes their files and, at the end, those of all that
// were finished. The first one's take the place of an earlier run's. One that fails is named and
// does not keep the others from running; a single one throws.
int run_views(const Arguments& arguments, const Setting& setting, const ResultFolder& out,
              const std::vector<std::pair<int, Camera>>& views) {
  Json all;
  all["schema_version"] = 2;
  all["config"] = setting.resolved;
  all["failed"] = Json::array();
  std::vector<ViewResult> results;
  bool equal = true;
  print_table_head();
  for (const auto& [number, camera] : views) {
    try {
      ViewResult view = simulate_view(setting.scene, number, camera, setting.config,
                                      setting.technology, arguments.run);
      Json report = full_report(arguments, setting, view);
      write_view(out.view(number), view, report);
      if (results.empty()) out.keep_only(number);
      print_table_line(view);
      equal = equal && view.equals_golden;
      all["views"].push_back(std::move(report));
      results.push_back(std::move(view));
    } catch (const std::exception& error) {
      if (views.size() == 1) throw;
      std::fflush(stdout);
      fmt::print(stderr, "streaminggs: view {}: {}\n", number, error.what());
      all["failed"].push_back({{"view", number}, {"why", error.what()}});
    }
    std::fflush(stdout);
  }
  if (results.empty()) throw std::runtime_error("no view could be finished");
  write_text(out.report(), text_of(all));
  for (const ViewResult& view : results) print_details(view);
  print_scene(setting.scene, setting.config, arguments.drop_invalid);
  print_machine(results.front(), setting.config.chosen, setting.technology.name);
  for (const Json& view : all["failed"]) {
    fmt::print("\nview {} failed: {}\n", view["view"].get<int>(), view["why"].get<std::string>());
  }
  if (!equal) fmt::print("\nthe frame differs from the golden renderer's\n");
  return equal && all["failed"].empty() ? 0 : 1;
}

int run(const Arguments& arguments, const Kinds& kinds) {
  Setting setting;
  setting.began = std::chrono::steady_clock::now();
  RunConfig& config = setting.config;
  config = read_run_config(arguments.config.document(), kinds);
  std::optional<PackedScene> packed = arguments.load_packed();
  if (packed) {
    resolve(config, *packed, arguments.scene, arguments.config.preset_path());
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
  const ResultFolder out(arguments.out.empty() ? arguments.default_out(arguments.config.name())
                                               : arguments.out);
  const bool one_view_only =
      !arguments.run.vcd_path.empty() || !arguments.run.dram_trace_path.empty();
  if (one_view_only && arguments.view.find_first_not_of("0123456789") != std::string::npos) {
    throw InputError(
        "--vcd, --dram-trace: one file holds one view; expected --view with one number");
  }
  setting.technology = load_technology(arguments.technology);
  Scene scene;
  if (!packed) scene = arguments.load();
  const auto views = arguments.cameras(scene.cameras);
  check_places(arguments, config, out, views);
  if (packed) {
    setting.scene = prepare(std::move(*packed), arguments.scene, config);
  } else {
    const std::vector<Camera> weighing = arguments.weighing_cameras(scene.cameras);
    setting.scene = prepare(std::move(scene), config, weighing);
  }
  setting.resolved = Json::parse(to_json(config));
  return run_views(arguments, setting, out, views);
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
                 "folder for pictures and reports; out/SCENE/CONFIG by their names if not given")
      ->check(not_empty());
  app.add_option("--vcd", arguments->run.vcd_path, "write a waveform")->check(not_empty());
  app.add_option("--dram-trace", arguments->run.dram_trace_path,
                 "write every DRAM command; tb_dram --check verifies it")
      ->check(not_empty());
  app.add_option("--technology", arguments->technology, "table of energy and area")
      ->check(not_empty())
      ->capture_default_str();
  BuildOptions& build = arguments->run.build;
  app.add_option("--stalls", build.stalls.probability,
                 "probability, as 0.1, of a random stall at each side of each FIFO, for tests")
      ->check(real_number(0, 1));
  app.add_option("--seed", build.stalls.seed, "of the random stalls")
      ->check(whole_number(0, kMostSeed))
      ->capture_default_str();
  app.add_option("--construction-order", build.construction_order,
                 "seed that shuffles the order in which units are made; changes no number")
      ->check(whole_number(0, kMostSeed));
  app.add_flag("--print-config", arguments->print_config, "show the resolved configuration");
  return [arguments, &kinds] {
    arguments->command = command_line();
    return run(*arguments, kinds);
  };
}

}  // namespace sgs
