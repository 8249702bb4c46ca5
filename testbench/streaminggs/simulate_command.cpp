// streaminggs simulate SCENE --out DIR
#include <fmt/format.h>

#include <charconv>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "algorithm/files/data_files.h"
#include "algorithm/files/input_error.h"
#include "algorithm/files/input_json.h"
#include "algorithm/files/output_file.h"
#include "algorithm/render/group_state.h"
#include "modules/dram/memspec.h"
#include "testbench/command_line/config_source.h"
#include "testbench/streaminggs/commands.h"
#include "testbench/streaminggs/report/provenance.h"
#include "testbench/streaminggs/report/result_folder.h"
#include "testbench/streaminggs/run/camera_path.h"
#include "testbench/streaminggs/run/clock_check.h"
#include "testbench/streaminggs/run/path_run.h"
#include "testbench/streaminggs/run/scene_arguments.h"
#include "testbench/streaminggs/run/second_eye.h"
#include "testbench/streaminggs/run/stream_run.h"
#include "testbench/streaminggs/run/view_run.h"

namespace sgs {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct SimulateArguments : SceneArguments {
  ConfigSource config;
  std::string out;
  std::string technology = data_file("technology_32nm.json");
  RunOptions run;
  std::string timeline_groups;          // "A-B", "A", or empty
  std::string path;                     // the camera's path; empty: views
  std::optional<std::uint32_t> frames;  // along it
  bool stream = false;                  // the path's frames back to back
  std::string stereo;                   // "ipd=DISTANCE"; empty: one eye
  bool print_config = false;
  bool verbose = false;
  std::string command;  // the whole command line
};

// Refuses outputs that have no place, or would take that of an input, before the run begins.
// new_files: of the views or the path.
void check_places(const SimulateArguments& arguments, const RunConfig& config,
                  const ResultFolder& out, const std::vector<fs::path>& new_files) {
  OutputPlan plan;
  arguments.add_inputs_to(plan);
  if (is_path_file(arguments.path)) plan.add_input(arguments.path);
  plan.add_input(arguments.config.path());
  plan.add_input(arguments.technology);
  plan.add_input(memspec_path(config.dram.memspec));
  for (const std::string& file :
       {arguments.run.vcd_path, arguments.run.timeline_path, arguments.run.dram_trace_path}) {
    if (!file.empty()) plan.add_output(file);
  }
  plan.add_output(out.report().string());
  std::set<fs::path> files(new_files.begin(), new_files.end());
  // Those of an earlier run will be removed.
  const std::vector<fs::path> earlier = out.present();
  files.insert(earlier.begin(), earlier.end());
  for (const fs::path& file : files) plan.add_output(file.string());
  plan.check();
}

// Reads "4-7" or "4"; an empty text means all groups.
GroupRange range_of(const std::string& text) {
  GroupRange range;
  if (text.empty()) return range;
  const char* const end = text.data() + text.size();
  std::from_chars_result read = std::from_chars(text.data(), end, range.first);
  range.last = range.first;
  if (read.ec == std::errc() && read.ptr != end && *read.ptr == '-') {
    read = std::from_chars(read.ptr + 1, end, range.last);
  }
  if (read.ec != std::errc() || read.ptr != end || range.last < range.first) {
    throw InputError(fmt::format(
        "--timeline-groups: got '{}', expected a number, or two as in 4-7, the lower first", text));
  }
  return range;
}

// Checks the range against the groups of a single frame, whose camera this is.
void check_groups(const std::string& text, const GroupRange& range, const MachineDesign& design,
                  const Camera& camera) {
  if (text.empty() || design.piece() == PixelSize{}) return;
  const std::size_t count = pixel_groups(camera.width, camera.height, design.piece()).size();
  if (range.last < count) return;
  throw InputError(fmt::format("--timeline-groups: got '{}', the frame has {}: expected 0 to {}",
                               text, count, count - 1));
}

// One file each of one simulation.
void check_single(const SimulateArguments& arguments) {
  const RunOptions& run = arguments.run;
  if (run.vcd_path.empty() && run.timeline_path.empty() && run.dram_trace_path.empty()) return;
  if (arguments.stream) return;
  if (!arguments.path.empty()) {
    throw InputError(
        "--vcd, --timeline, --dram-trace: one file holds one simulation; expected them without "
        "--path, "
        "or with --stream");
  }
  if (arguments.view.find_first_not_of("0123456789") == std::string::npos) return;
  throw InputError(
      "--vcd, --timeline, --dram-trace: one file holds one view; expected --view with one number");
}

// Cameras beside a path have one use: they weigh codebooks that are made.
void check_cameras_of_path(const SimulateArguments& arguments, SecondHalfEncoding encoding,
                           bool packed) {
  const bool weighs = !packed && SecondHalfFormat{encoding, 0, {}}.quantised();
  if (arguments.path.empty() || arguments.cameras_path.empty() || weighs) return;
  throw InputError(fmt::format(
      "--cameras: got {} with --path {}, which says what is drawn, expected one of the two, or "
      "codebooks to be made, which these cameras weigh",
      arguments.cameras_path, arguments.path));
}

constexpr double kLeastRate = 1e-3, kMostRate = 1e6;

// Refuses a rate that stands for no display.
void check_rates(const SimulateArguments& arguments) {
  for (const double rate : arguments.run.frame_rates) {
    if (rate > 0 || arguments.stream) continue;
    throw InputError(
        fmt::format("--frame-rate: got 0, expected a number from {} to {}, or 0 with --stream",
                    kLeastRate, kMostRate));
  }
}

// Refuses a stream of one frame, or one that lasts longer than the kernel can count.
void check_stream(const PathJob& job) {
  constexpr double kMostSeconds = 10000;
  if (job.frames.size() < 2) {
    throw InputError("--frames: got 1, expected 2 or more with --stream");
  }
  const double seconds = static_cast<double>(job.frames.size()) / job.frame_rate;
  if (job.frame_rate == 0 || seconds < kMostSeconds) return;
  throw InputError(
      fmt::format("--frame-rate: got {}: {} frames take {:g} s, expected less than {:g} s",
                  job.frame_rate, job.frames.size(), seconds, kMostSeconds));
}

// keys: the path's, in their own size.
PathJob path_job(const SimulateArguments& arguments, std::vector<Camera>& keys) {
  CameraPath path = read_camera_path(arguments.path, arguments.scene);
  keys = path.keys;
  NumberedCameras numbered;
  for (const Camera& key : keys) numbered.emplace_back(numbered.size(), key);
  const ChosenCameras sized = arguments.in_size(std::move(numbered), path.name);
  if (!path.note.empty()) fmt::print("{}: {}\n", path.name, path.note);
  for (const std::string& note : sized.notes) fmt::print("{}\n", note);
  for (const auto& [number, camera] : sized.views)
    path.keys[static_cast<std::size_t>(number)] = camera;
  const std::vector<double>& rates = arguments.run.frame_rates;
  if (rates.size() > 1) {
    throw InputError(
        fmt::format("--frame-rate: got {} rates, expected one with --path", rates.size()));
  }
  constexpr double kUsualRate = 90;
  const double usual = arguments.stream ? 0 : path.facts.frame_rate.value_or(kUsualRate);
  PathJob job{path.name, frames_along(path, arguments.frames),
              rates.empty() ? usual : rates.front()};
  if (arguments.stream) check_stream(job);
  return job;
}

// Prints the machine, the precision if it has one for blending, how the scene is stored, and which
// sizes of memories give way.
void print_what_runs(RunSetting& setting) {
  const Json config = parse_json(to_json(setting.config), "the configuration");
  const std::string precision =
      config.value(Json::json_pointer("/rendering/precision"), std::string());
  fmt::print("{}: machine {}, {}second halves {}\n", setting.facts.configuration,
             config.at("machine").get<std::string>(),
             precision.empty() ? "" : fmt::format("blends in {}, ", precision),
             config.at("storage").at("encoding").get<std::string>());
  if (!setting.config.sizes_replaced.empty()) fmt::print("{}\n", setting.config.sizes_replaced);
  const Technology& technology = setting.technology;
  if (technology.path != data_file("technology_32nm.json")) {
    fmt::print("costs by {}, {}\n", technology.path, technology.name);
  }
}

// Prints where tables of the memory's numbers disagree: those of shipped memspecs are known.
void print_notes_of_memory(const std::string& memspec, Detail detail) {
  const bool shipped = memspec.rfind(memspec_path(memspec), 0) != 0;
  if (detail == Detail::kShort && shipped) return;
  for (const std::string& warning : check_memspec(load_memspec(memspec), memspec)) {
    fmt::print(stderr, "streaminggs: note: {}\n", warning);
  }
}

int run(const SimulateArguments& arguments, const Kinds& kinds) {
  check_rates(arguments);
  RunSetting setting;
  setting.facts.began = std::chrono::steady_clock::now();
  RunConfig& config = setting.config;
  config = read_run_config(arguments.config, kinds);
  std::optional<PackedScene> packed = arguments.load_packed();
  check_cameras_of_path(arguments, config.storage.encoding, packed.has_value());
  const double apart = eyes_apart(arguments.stereo);
  draw_eyes(config, apart);
  std::vector<Camera> keys;
  std::optional<PathJob> path;
  if (!arguments.path.empty()) path = path_job(arguments, keys);
  config.design->fit_frames([&]() -> std::vector<PixelSize> {
    if (!path) return arguments.frame_sizes();
    return {{path->frames[0].width, path->frames[0].height}};
  });
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
    // Values that were left open stay so: they follow from others, which a reader of this may
    // change. Where memories are fitted, what their configured sizes decide is shown.
    const ConfigSource& source = arguments.config;
    RunConfig shown = source.fit_memories ? as_decided(source.document(), config)
                                          : read_run_config(source.document(), kinds);
    if (packed) shown.storage = packed->storage;
    if (apart > 0) shown.design->draw_two_eyes();
    fmt::print("{}\n", to_json(shown));
    return 0;
  }
  const ResultFolder out(arguments.out.empty() ? arguments.default_out(arguments.config.name())
                                               : arguments.out);
  check_single(arguments);
  setting.technology = load_technology(arguments.technology);
  setting.options = arguments.run;
  if (arguments.verbose) setting.detail = Detail::kAll;
  setting.options.timeline_groups = range_of(arguments.timeline_groups);
  setting.facts.technology = setting.technology.name;
  setting.facts.technology_path = setting.technology.path;
  setting.facts.technology_hash = xxh64_of_file(setting.technology.path);
  setting.facts.seed = arguments.run.build.stalls.seed;
  setting.facts.configuration = arguments.config.in_words();
  setting.facts.command = arguments.command;
  Scene scene;
  if (!packed) scene = arguments.load();
  NumberedCameras views;
  if (!path) views = arguments.cameras(scene.cameras);
  for (auto& [number, camera] : views) camera.eyes_apart = apart;
  for (std::size_t i = 0; path && i < path->frames.size(); ++i) path->frames[i].eyes_apart = apart;
  if (!views.empty()) {
    check_groups(arguments.timeline_groups, setting.options.timeline_groups, *config.design,
                 views.front().second);
  }
  check_places(arguments, config, out,
               path ? files_of_path(*path, out) : files_of_views(views, out));
  if (packed) {
    setting.scene = prepare(std::move(*packed), arguments.scene, config);
  } else {
    // A path weighs a scene that brings no cameras of its own.
    const std::vector<Camera> weighing = arguments.weighing_cameras(
        scene.cameras.empty() ? keys : scene.cameras, config.storage.encoding);
    setting.scene = prepare(std::move(scene), config, weighing, CodebookCache(arguments.cache));
  }
  print_what_runs(setting);
  if (!setting.technology.note.empty())
    fmt::print(stderr, "streaminggs: note: {}\n", setting.technology.note);
  const std::string doubt = doubt_about_clock(config, setting.technology);
  if (!doubt.empty()) fmt::print(stderr, "streaminggs: note: {}\n", doubt);
  const auto run_frames = arguments.stream ? run_stream : run_path;
  const int status = path ? run_frames(*path, setting, out, arguments.drop_invalid)
                          : run_views(views, setting, out, arguments.drop_invalid);
  print_notes_of_memory(config.dram.memspec, setting.detail);
  return status;
}

}  // namespace

SubCommand add_simulate_command(CommandLine& line, const Kinds& kinds) {
  auto arguments = std::make_shared<SimulateArguments>();
  arguments->add_scene_to(line);
  arguments->add_views_to(line);
  arguments->add_weighing_to(line);
  arguments->add_cache_to(line);
  arguments->config.config = kinds.front().name;
  arguments->config.add_to(line);
  arguments->config.add_fitting_to(line);
  line.file("--out", arguments->out,
            "folder for pictures and reports; out/SCENE/CONFIG by their names if not given");
  line.file("--vcd", arguments->run.vcd_path, "write a waveform");
  line.file("--timeline", arguments->run.timeline_path, "write a trace for ui.perfetto.dev");
  line.text("--timeline-groups", arguments->timeline_groups,
            "groups of pixels (or tiles) that it is bound to, as in 4-7 or 4");
  line.needs("--timeline-groups", "--timeline");
  line.file("--dram-trace", arguments->run.dram_trace_path,
            "write every DRAM command; tb_dram --check verifies it");
  line.file("--path", arguments->path,
            "cameras as key frames, builtin:path, or a camera path of nerfstudio; every frame is "
            "drawn");
  line.whole("--frames", arguments->frames, 1U, 100000U,
             "along the path; if not given 60, or those that nerfstudio's states");
  line.reals_or_0(
      "--frame-rate", arguments->run.frame_rates, kLeastRate, kMostRate,
      "frames a second at which joules a second are told, as in 60,90, with the memory's rest "
      "between frames; of a path one: if not given as nerfstudio's states or 90, with --stream 0");
  line.flag(
      "--stream", arguments->stream,
      "the path's frames back to back in one simulation, shown at --frame-rate; as fast as it "
      "goes with 0, or none");
  line.needs("--stream", "--path");
  add_stereo_to(line, arguments->stereo);
  line.excludes("--view", "--path");
  line.needs("--frames", "--path");
  line.file("--technology", arguments->technology, "table of energy and area");
  BuildOptions& build = arguments->run.build;
  line.real("--stalls", build.stalls.probability, 0, 1,
            "probability, as 0.1, of a random stall at each side of each FIFO, for tests");
  line.whole("--seed", build.stalls.seed, 0, kMostSeed, "of the random stalls");
  line.needs("--seed", "--stalls");
  line.whole(
      "--process-order", build.jitter_seed, 0, kMostSeed,
      "seed that shuffles in which order the processes of an instant act; changes no number");
  line.flag("--verbose", arguments->verbose,
            "print also losses, lanes, area by component and what the model chose");
  line.flag("--print-config", arguments->print_config,
            "show every key of the configuration: what --config takes; 0 where it is left open, "
            "with --fit-memories only where it follows from other keys");
  return [arguments, &kinds] {
    arguments->command = command_line();
    return run(*arguments, kinds);
  };
}

}  // namespace sgs
