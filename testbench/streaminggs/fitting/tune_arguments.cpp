#include "testbench/streaminggs/fitting/tune_arguments.h"

#include <fmt/format.h>

#include <utility>

#include "algorithm/files/input_error.h"
#include "algorithm/storage/image_file.h"
#include "testbench/command_line/output_name.h"

namespace sgs {

void TuneArguments::add_to(CommandLine& line) {
  add_scene_to(line, kUnpackedSceneForms);
  line.flag("--boundary", boundary,
            "for paper order: less that is blended out of order; centres rest");
  line.flag("--quantise", quantise,
            "for codebooks: entries and Gaussians learned together; centres rest");
  line.flag("--streaming", streaming,
            "for fewer bytes in exact order: Gaussians pay for what they are fetched for; centres "
            "rest");
  line.file("--data", data.folder,
            "the folder of a data set; without, the scene's own "
            "reference pictures are what it is to look like");
  data.add_options_to(line);
  for (const char* name : DatasetArguments::kNames) line.needs(name, "--data");
  line.text("--target", target,
            "the scene whose reference pictures these are, where it is not SCENE itself: what "
            "SCENE was before it was tuned");
  line.file("--cameras", cameras_path,
            "cameras of these pictures, every eighth to test with; built-in scenes bring their "
            "own, others need it: none are made out of nothing");
  line.text("--size", size, "WIDTHxHEIGHT in px; scales the intrinsics");
  line.whole("--between", between, 0, 100'000,
             "so many cameras made to tune on, those given all to test with: each between two of "
             "them drawn by lot, on the line between the centres, turned the shortest way");
  config.add_to(line);
  config.add_fitting_to(line);
  FittingArguments::add_to(line, "scene to write: .sgs with --quantise, else .ply");
  line.whole("--steps", steps, 1, 1'000'000,
             "a picture each; 3,000 if not given, with --quantise 5,000");
  line.whole("--seed", seed, 0, kMostSeed, "of all that is drawn by lot");
  line.real("--rate", rate, 1e-6, 1'000,
            "of learning, times the original's; 1 if not given, with --quantise and --streaming "
            "0.2");
  line.real("--beta", beta, 0, 1e9, "of L_CBP in the loss");
  line.one_of({"group", "pixel"}, "--misordered-in", misordered_in,
              "where a Gaussian comes behind a farther one: in its group or at a pixel of its own");
  line.one_of({"rendered", "scene"}, "--penalty-mean", penalty_mean,
              "what L_CBP is a mean over: (group, Gaussian) pairs or all Gaussians");
  line.whole("--reassign-every", reassign_every, 1, 1'000'000,
             "steps: every Gaussian finds its nearest entries anew");
  for (const char* name : {"--beta", "--misordered-in", "--penalty-mean"}) {
    line.needs(name, "--boundary");
  }
  line.needs("--reassign-every", "--quantise");
  line.real("--price", price, 0, 1e9, "of a fetch in the loss");
  line.needs("--price", "--streaming");
  line.whole("--visit-memory", visit_memory_mb, 0, 1'000'000,
             "MB of visits that are kept; those of further views are made anew each time");
}

void TuneArguments::check() const {
  const int purposes = (boundary ? 1 : 0) + (quantise ? 1 : 0) + (streaming ? 1 : 0);
  if (purposes != 1) {
    throw InputError(
        fmt::format("tune: got {} to tune for, expected one of --boundary, --quantise, --streaming",
                    purposes == 0 ? "nothing" : "several things"));
  }
  check_output_name(out, quantise ? kImageFileExtension : ".ply");
  if (data.folder.empty()) return;
  const std::pair<const char*, bool> of_cameras[] = {{"--cameras", !cameras_path.empty()},
                                                     {"--size", !size.empty()},
                                                     {"--between", between > 0},
                                                     {"--target", !target.empty()}};
  for (const auto& [name, given] : of_cameras) {
    if (given) throw InputError(fmt::format("{}: the data set brings its views", name));
  }
}

void TuneArguments::set(TuningConfig& tuning, int own_steps, double own_rate) const {
  tuning.steps = steps ? static_cast<int>(*steps) : own_steps;
  tuning.rate = rate.value_or(own_rate);
  tuning.seed = seed;
  tuning.comparison.gradients = gradient_rule();
}

std::string TuneArguments::work() const {
  std::string line = fmt::format("tune {} --{} --config {}", scene, purpose(), config.config);
  for (const std::string& value : config.overrides) line += " --set " + value;
  if (data.folder.empty()) {
    line += fmt::format(" --cameras {} --size {} --between {}", cameras_path, size, between);
    if (!target.empty()) line += " --target " + target;
  } else {
    line += " --data " + data.work();
  }
  line += fmt::format(" --seed {} --gradients {}", seed, gradients);
  if (quantise) return line + fmt::format(" --reassign-every {}", reassign_every);
  if (streaming) return line + fmt::format(" --price {}", price);
  return line + fmt::format(" --beta {} --misordered-in {} --penalty-mean {}", beta, misordered_in,
                            penalty_mean);
}

std::string TuneArguments::pace(const TuningConfig& tuning) const {
  return fmt::format("--steps {} --rate {}", tuning.steps, tuning.rate);
}

}  // namespace sgs
