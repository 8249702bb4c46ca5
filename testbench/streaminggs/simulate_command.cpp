// streaminggs simulate SCENE --out DIR
#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "algorithm/data_files.h"
#include "algorithm/image/image_io.h"
#include "algorithm/input_error.h"
#include "algorithm/output_file.h"
#include "algorithm/output_plan.h"
#include "algorithm/output_set.h"
#include "testbench/command_line/config_source.h"
#include "testbench/streaminggs/commands.h"
#include "testbench/streaminggs/error_maps.h"
#include "testbench/streaminggs/group_table.h"
#include "testbench/streaminggs/provenance.h"
#include "testbench/streaminggs/result_folder.h"
#include "testbench/streaminggs/run_report.h"
#include "testbench/streaminggs/scene_arguments.h"
#include "testbench/streaminggs/terminal.h"

namespace sgs {
namespace {

namespace fs = std::filesystem;

struct SimulateArguments : SceneArguments {
  ConfigSource config;
  std::string out;
  std::string technology = data_file("technology_32nm.json");
  RunOptions run;
  bool print_config = false;
  std::string command;  // the whole command line
};

void write_text(const fs::path& path, const std::string& text) {
  write_whole_file(path.string(), text.data(), text.size());
}

// All files of a view at once: no picture stands beside the report of another run.
void write_view(const fs::path& folder, const ViewResult& view, const std::string& report) {
  OutputSet files;
  const auto add = [&](const std::string& file) -> OutputFile& {
    return files.add((folder / file).string());
  };
  write_image(add("frame.exr"), view.frame);
  write_image(add("frame.png"), view.frame);
  write_image(add("reference.exr"), view.reference);
  write_image(add("reference.png"), view.reference);
  add("report.json").write(report);
  std::set<std::string> old(std::begin(kErrorMapFiles), std::end(kErrorMapFiles));
  old.insert(kGroupTableFile);
  if (const std::string groups = group_table(view); !groups.empty()) {
    add(kGroupTableFile).write(groups);
    old.erase(kGroupTableFile);
  }
  for (const ErrorMap& map : error_maps(view)) {
    write_image(add(map.file), map.image);
    old.erase(map.file);
  }
  files.commit();
  for (const std::string& file : old) fs::remove(folder / file);
}

// Refuses outputs that have no place, or would take that of an input, before the work begins.
void check_places(const SimulateArguments& arguments, const RunConfig& config,
                  const ResultFolder& out, const std::vector<std::pair<int, Camera>>& views) {
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
  std::chrono::steady_clock::time_point began;
};

// Simulates the views one after the other and writes their files and, at the end, those of all that
// were finished. The first one's take the place of an earlier run's. One that fails is named and
// does not keep the others from running; a single one throws.
int run_views(const SimulateArguments& arguments, Setting& setting, const ResultFolder& out,
              const std::vector<std::pair<int, Camera>>& views) {
  const std::string& table = setting.technology.path;
  RunReport report(setting.config,
                   {setting.technology.name, table, fnv1a64_of_file(table),
                    arguments.run.build.stalls.seed, arguments.command, setting.began});
  std::vector<std::pair<int, std::string>> failed;
  std::vector<ViewResult> results;
  bool equal = true;
  print_table_head();
  for (const auto& [number, camera] : views) {
    try {
      ViewResult view = simulate_view(setting.scene, number, camera, setting.config,
                                      setting.technology, arguments.run);
      const auto of_view = report.of_view(view, setting.scene);
      write_view(out.view(number), view, report_text(*of_view));
      if (results.empty()) out.keep_only(number);
      print_table_line(view);
      equal = equal && view.equals_golden;
      report.add(*of_view);
      results.push_back(std::move(view));
    } catch (const std::exception& error) {
      if (views.size() == 1) throw;
      std::fflush(stdout);
      fmt::print(stderr, "streaminggs: view {}: {}\n", number, error.what());
      failed.emplace_back(number, error.what());
    }
    std::fflush(stdout);
  }
  if (results.empty()) throw std::runtime_error("no view could be finished");
  write_text(out.report(), report.text(failed));
  for (const ViewResult& view : results) print_details(view);
  print_scene(setting.scene, setting.config, arguments.drop_invalid);
  print_machine(results.front(), setting.config.chosen, setting.technology.name);
  for (const auto& [view, why] : failed) fmt::print("\nview {} failed: {}\n", view, why);
  if (!equal) fmt::print("\nthe frame differs from the golden renderer's\n");
  fmt::print("\nwritten to {}\n", out.report().parent_path().string());
  return equal && failed.empty() ? 0 : 1;
}

int run(const SimulateArguments& arguments, const Kinds& kinds) {
  Setting setting;
  setting.began = std::chrono::steady_clock::now();
  RunConfig& config = setting.config;
  config = read_run_config(arguments.config.document(), kinds);
  std::optional<PackedScene> packed = arguments.load_packed();
  config.design->fit_frames([&] { return arguments.frame_sizes(); });
  if (packed) {
    resolve(config, *packed, arguments.scene, arguments.config.preset_in_words());
  } else {
    resolve(config);
  }
  if (arguments.print_config) {
    if (packed) {
      adapt(config, *packed);
    } else {
      adapt(config, arguments.load());
    }
    // What was left open stays so: it follows from what else a reader of this may change.
    RunConfig as_read = read_run_config(arguments.config.document(), kinds);
    if (packed) as_read.storage = packed->storage;
    fmt::print("{}\n", to_json(as_read));
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
    const std::vector<Camera> weighing =
        arguments.weighing_cameras(scene.cameras, config.storage.encoding);
    setting.scene = prepare(std::move(scene), config, weighing);
  }
  return run_views(arguments, setting, out, views);
}

}  // namespace

SubCommand add_simulate_command(CommandLine& line, const Kinds& kinds) {
  auto arguments = std::make_shared<SimulateArguments>();
  arguments->add_scene_to(line);
  arguments->add_views_to(line);
  arguments->add_weighing_to(line);
  arguments->config.config = kinds.front().name;
  arguments->config.add_to(line);
  line.file("--out", arguments->out,
            "folder for pictures and reports; out/SCENE/CONFIG by their names if not given");
  line.file("--vcd", arguments->run.vcd_path, "write a waveform");
  line.file("--dram-trace", arguments->run.dram_trace_path,
            "write every DRAM command; tb_dram --check verifies it");
  line.file("--technology", arguments->technology, "table of energy and area");
  BuildOptions& build = arguments->run.build;
  line.real("--stalls", build.stalls.probability, 0, 1,
            "probability, as 0.1, of a random stall at each side of each FIFO, for tests");
  line.whole("--seed", build.stalls.seed, 0, kMostSeed, "of the random stalls");
  line.needs("--seed", "--stalls");
  line.whole(
      "--process-order", build.process_order, 0, kMostSeed,
      "seed that shuffles in which order the processes of an instant act; changes no number");
  line.flag("--print-config", arguments->print_config,
            "show every key of the configuration: what --config takes; 0 where it is left open");
  return [arguments, &kinds] {
    arguments->command = command_line();
    return run(*arguments, kinds);
  };
}

}  // namespace sgs
