// streaminggs what-if SCENE: the frame as configured, then with twice as much of each thing.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "algorithm/files/data_files.h"
#include "algorithm/files/input_error.h"
#include "algorithm/files/output_file.h"
#include "algorithm/memory/frame_buffer.h"
#include "testbench/command_line/config_source.h"
#include "testbench/command_line/output_name.h"
#include "testbench/result/collect.h"
#include "testbench/streaminggs/commands.h"
#include "testbench/streaminggs/report/frame_noise.h"
#include "testbench/streaminggs/report/memory_interface.h"
#include "testbench/streaminggs/run/camera_check.h"
#include "testbench/streaminggs/run/clock_check.h"
#include "testbench/streaminggs/run/frame_run.h"
#include "testbench/streaminggs/run/prepared_scene.h"
#include "testbench/streaminggs/run/progress.h"
#include "testbench/streaminggs/run/scene_arguments.h"
#include "testbench/streaminggs/run/second_eye.h"
#include "testbench/streaminggs/what_if/what_if.h"

namespace sgs {
namespace {

using Json = nlohmann::ordered_json;

struct WhatIfArguments : SceneArguments {
  ConfigSource config;
  std::string technology = data_file("technology_32nm.json");
  std::string out;     // JSON; empty: the terminal alone
  std::string stereo;  // "ipd=DISTANCE"; empty: one eye
};

// A scene, and a machine for it.
struct Base {
  std::string document;  // the configuration, with what was decided for the frame
  std::string resolved;  // and with all that was chosen
  PreparedScene scene;
  Technology technology;
  const Kinds* kinds = nullptr;
  double eyes_apart = 0;

  // The configuration with one value changed; empty: as it is. What is derived follows anew, and
  // memories become as large as that takes. Throws InputError where it cannot be.
  RunConfig variant(const std::string& assignment) const {
    ConfigDocument changed;
    changed.add_text(document, "the configuration");
    if (!assignment.empty()) changed.add_override(assignment);
    RunConfig config = read_run_config(changed, *kinds);
    draw_eyes(config, eyes_apart);
    fit_memories(config);
    resolve(config);
    adapt(config, scene.stored.image.layout.second_half);
    return config;
  }
};

class NothingLeftOut : public DataSheet {};

GoldenFrame golden_of(const Base& base, const RunConfig& config, const FrameJob& job) {
  NothingLeftOut sheet;
  return config.design->golden(base.scene.stored, job, sheet);
}

// Frame buffers of the left or only eye, and of the right one, which may be missing.
using Buffers = std::pair<std::vector<std::byte>, std::vector<std::byte>>;

Buffers buffers_of(const FrameJob& job, const GoldenFrame& golden) {
  return {encode_frame(job.frame_format, golden.image),
          encode_frame(job.frame_format, golden.right)};
}

// One frame of a variant. golden: the picture of the machine as it is. Few keys make another one
// (of paper order the rays in flight, which break ties): the variant's own is drawn for these only.
FrameResult run(const Base& base, const RunConfig& config, const Camera& camera,
                const Buffers& golden, const std::string& what) {
  const FrameJob job = config.design->job(base.scene.stored, camera);
  FrameResult frame = run_frame(*config.design, job, base.scene.stored.image, config.dram, {});
  const Buffers drawn{frame.frame, frame.right_frame};
  if (drawn != golden && drawn != buffers_of(job, golden_of(base, config, job))) {
    throw std::runtime_error(what + ": the frame differs from the streaming renderer's");
  }
  return frame;
}

Outcome outcome_of(const FrameResult& frame, const Technology& technology) {
  const Totals area = area_totals(frame, technology);
  return {frame.cycles,
          frame.memory.bus_bytes,
          energy_of(frame, technology).total.middle,
          area_of(frame, technology).total.middle,
          area.with_memory_interface.middle,
          frame.memory.energy_not_stated,
          find_binding(frame, area)};
}

// The number at "key.path" of a document.
double value_at(const Json& document, std::string key) {
  for (char& c : key) c = c == '.' ? '/' : c;
  return document.at(Json::json_pointer("/" + key)).get<double>();
}

void print(const Outcome& base, const std::vector<Doubling>& doublings) {
  fmt::print("{:<34} {:>8} {:>8} {:>12} {:>8} {:>10} {:>9} {:>9} {:>10} {:>10}   then holds\n",
             "doubled", "from", "to", "cycles", "time", "energy", "mm2", "with PHY", "time/mm2",
             "energy/mm2");
  fmt::print("{:<34} {:>8} {:>8} {:>12} {:>8} {:>10} {:>9.3f} {:>9.3f} {:>10} {:>10}   {}\n",
             "nothing", "", "", base.cycles, "", fmt::format("{:.3f} mJ", 1e3 * base.joules),
             base.mm2, base.mm2_with_memory_interface, "", "", base.binding.holds);
  for (const Doubling& d : doublings) {
    if (!d.refused.empty()) continue;
    const double time = time_saved(base, d.outcome), energy = energy_saved(base, d.outcome);
    fmt::print("{:<34} {:>8} {:>8} {:>12} {:>8} {:>10} {:>+9.3f} {:>+9.3f} {:>10} {:>10}   {}{}\n",
               d.key, d.from, d.to, d.outcome.cycles, change_in_words(time),
               change_in_words(energy), d.outcome.mm2 - base.mm2,
               d.outcome.mm2_with_memory_interface - base.mm2_with_memory_interface,
               time_is_noise(base, d.outcome) ? "-" : saved_per_mm2(base, d.outcome, time),
               energy_is_noise(base, d.outcome) ? "-" : saved_per_mm2(base, d.outcome, energy),
               d.outcome.binding.holds, noise_in_words(base, d.outcome));
  }
  fmt::print(
      "with PHY: mm2 with PHY and controller of the memory's channels; -: less than {:g} % of that "
      "is added, or it is {}\n",
      100 * kLeastAddedArea, kBelowNoise);
  if (!base.memory_not_stated.empty())
    fmt::print("energy is without the memory's: its memspec does not state {}\n",
               base.memory_not_stated);
  for (const Doubling& d : doublings) {
    if (!d.refused.empty()) fmt::print("{}={}: cannot be: {}\n", d.key, d.to, d.refused);
  }
}

Json to_json(const Outcome& outcome) {
  return {{"cycles", outcome.cycles},
          {"bus_bytes", outcome.bus_bytes},
          {"energy_j", outcome.joules},
          {"memory_known", outcome.memory_not_stated.empty()},
          {"area_mm2", outcome.mm2},
          {"area_with_memory_interface_mm2", outcome.mm2_with_memory_interface},
          {"holds", outcome.binding.holds},
          {"holds_key", outcome.binding.remedy.key}};
}

Json to_json(int view, const Outcome& base, const std::vector<Doubling>& doublings,
             const std::string& verdict) {
  Json out = {{"view", view},
              {"base", to_json(base)},
              {"named_gains_most", named_gains_most(base, doublings)},
              {"verdict", verdict},
              {"doubled", Json::array()}};
  for (const Doubling& d : doublings) {
    Json row = {{"key", d.key}, {"from", d.from}, {"to", d.to}};
    if (d.refused.empty()) {
      row.update(to_json(d.outcome), true);
      row["time_saved"] = time_saved(base, d.outcome);
      row["time_below_noise"] = time_is_noise(base, d.outcome);
      row["energy_saved"] = energy_saved(base, d.outcome);
      row["energy_below_noise"] = energy_is_noise(base, d.outcome);
    } else {
      row["refused"] = d.refused;
    }
    out["doubled"].push_back(std::move(row));
  }
  return out;
}

Json run_view(const Base& base, int number, const Camera& camera) {
  const std::string doubt = doubt_about(camera, base.scene.given());
  if (!doubt.empty()) fmt::print("view {}: {}\n", number, doubt);
  const RunConfig config = base.variant("");
  const FrameJob job = config.design->job(base.scene.stored, camera);
  const GoldenFrame drawn = golden_of(base, config, job);
  const Buffers golden = buffers_of(job, drawn);
  const FrameResult frame = run(base, config, camera, golden, "nothing doubled");
  Outcome outcome = outcome_of(frame, base.technology);
  if (drawn.contributing == 0) {
    outcome.binding = without_advice(outcome.binding);
    fmt::print("\nview {}: {}\n", number, outcome.binding.sentence());
    return to_json(number, outcome, {}, outcome.binding.advice);
  }
  const Json resolved = Json::parse(base.resolved);
  const std::vector<Remedy> remedies = remedies_of(frame);
  std::vector<Doubling> doublings;
  std::optional<ProgressLine> progress(std::in_place);
  for (const Remedy& remedy : remedies) {
    progress->say(fmt::format("view {}: {} of {} keys tried, now {}", number,
                              &remedy - &remedies[0], remedies.size(), remedy.key));
    Doubling doubling(remedy, value_at(resolved, remedy.key));
    if (doubling.to == doubling.from) continue;  // it is as short as it can be
    try {
      const std::string what = fmt::format("{}={}", doubling.key, doubling.to);
      const RunConfig doubled = base.variant(what);
      doubling.outcome = outcome_of(run(base, doubled, camera, golden, what), base.technology);
    } catch (const InputError& error) {
      doubling.refused = error.what();
    }
    doublings.push_back(std::move(doubling));
  }
  progress.reset();
  rank(outcome, doublings);
  fmt::print("\nview {}: {}\n", number, outcome.binding.sentence());
  print(outcome, doublings);
  const std::string says = verdict(outcome, doublings);
  fmt::print("{}\n", says);
  std::fflush(stdout);
  return to_json(number, outcome, doublings, says);
}

int run(const WhatIfArguments& arguments, const Kinds& kinds) {
  Base base;
  base.kinds = &kinds;
  if (!arguments.out.empty()) check_output_name(arguments.out, ".json");
  base.eyes_apart = eyes_apart(arguments.stereo);
  RunConfig config = read_run_config(arguments.config, kinds);
  draw_eyes(config, base.eyes_apart);
  const std::string replaced = sizes_to_replace(config, arguments.config.preset_in_words());
  if (!replaced.empty()) fmt::print("{}\n", replaced);
  std::optional<PackedScene> packed = arguments.load_packed();
  config.design->fit_frames([&] { return arguments.frame_sizes(); });
  if (packed) {
    resolve(config, *packed, arguments.scene, arguments.config.preset_in_words());
  } else {
    resolve(config);
  }
  base.technology = load_technology(arguments.technology);
  Scene scene;
  if (!packed) scene = arguments.load();
  auto views = arguments.cameras(scene.cameras);
  for (auto& [number, camera] : views) camera.eyes_apart = base.eyes_apart;
  if (!arguments.out.empty()) {
    OutputPlan plan;
    arguments.add_inputs_to(plan);
    plan.add_input(arguments.config.path());
    plan.add_input(arguments.technology);
    plan.add_output(arguments.out);
    plan.check();
  }
  if (packed) {
    base.scene = prepare(std::move(*packed), arguments.scene, config);
  } else {
    const std::vector<Camera> weighing =
        arguments.weighing_cameras(scene.cameras, config.storage.encoding);
    base.scene = prepare(std::move(scene), config, weighing, CodebookCache(arguments.cache));
  }
  if (!base.technology.note.empty())
    fmt::print(stderr, "streaminggs: note: {}\n", base.technology.note);
  const std::string doubt = doubt_about_clock(config, base.technology);
  if (!doubt.empty()) fmt::print(stderr, "streaminggs: note: {}\n", doubt);
  base.resolved = to_json(config);
  RunConfig decided = as_decided(arguments.config.document(), config);
  draw_eyes(decided, base.eyes_apart);
  base.document = to_json(decided);
  Json report = Json::array();
  for (const auto& [number, camera] : views) report.push_back(run_view(base, number, camera));
  const MemoryInterface interface = memory_interface_of(config.dram, base.technology);
  if (!interface.area_known) fmt::print("{}\n", interface.in_words());
  if (!arguments.out.empty()) {
    const std::string text = report.dump(2) + "\n";
    write_whole_file(arguments.out, text.data(), text.size());
  }
  return 0;
}

}  // namespace

SubCommand add_what_if_command(CommandLine& line, const Kinds& kinds) {
  auto arguments = std::make_shared<WhatIfArguments>();
  arguments->add_scene_to(line);
  arguments->add_views_to(line);
  add_stereo_to(line, arguments->stereo);
  arguments->add_weighing_to(line);
  arguments->add_cache_to(line);
  arguments->config.config = kinds.front().name;
  arguments->config.add_to(line);
  arguments->config.add_fitting_to(line);
  line.file("--technology", arguments->technology, "table of energy and area");
  line.file("--out", arguments->out, "file to write the table to: .json");
  return [arguments, &kinds] { return run(*arguments, kinds); };
}

}  // namespace sgs
