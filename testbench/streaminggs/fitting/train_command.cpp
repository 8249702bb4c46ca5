// streaminggs train DATASET --out FILE.ply
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "algorithm/files/input_error.h"
#include "algorithm/files/output_file.h"
#include "algorithm/scene/ply_writer.h"
#include "algorithm/train/trainer.h"
#include "testbench/command_line/output_name.h"
#include "testbench/streaminggs/commands.h"
#include "testbench/streaminggs/fitting/dataset_arguments.h"
#include "testbench/streaminggs/fitting/fitting_run.h"
#include "testbench/streaminggs/report/numbers.h"

namespace sgs {
namespace {

struct TrainArguments : FittingArguments {
  DatasetArguments data;
  std::string growth = "mcmc";
  std::string background = "random";
  std::uint32_t steps = 20'000;
  std::uint64_t gaussians = 100'000;
  std::uint64_t seed = 1;
  std::uint32_t sh_degree = 3;

  // The training in words: a checkpoint must have been made with the same.
  std::string training() const {
    return fmt::format(
        "train {} --steps {} --gaussians {} --seed {} --sh-degree {} --growth {} "
        "--background {} --gradients {}",
        data.work(), steps, gaussians, seed, sh_degree, growth, background, gradients);
  }
};

TrainingConfig training_config(const TrainArguments& arguments) {
  TrainingConfig config;
  config.steps = static_cast<int>(arguments.steps);
  config.seed = arguments.seed;
  config.most_gaussians = arguments.gaussians;
  config.start_gaussians = std::min<std::size_t>(config.start_gaussians, arguments.gaussians);
  config.sh_degree = static_cast<int>(arguments.sh_degree);
  config.comparison.gradients = arguments.gradient_rule();
  if (arguments.growth == "original") {
    config.growth = Growth::kOriginal;
    config.start.opacity = 0.1;
    config.start.scale_share = 1;
  }
  if (arguments.background == "white") config.background = Background::kWhite;
  if (arguments.background == "black") config.background = Background::kBlack;
  return config;
}

std::vector<Camera> training_cameras(const Dataset& dataset) {
  std::vector<Camera> cameras;
  for (const int view : views_of(dataset, Split::kTrain)) {
    cameras.push_back(dataset.views[static_cast<std::size_t>(view)].camera);
  }
  return cameras;
}

GaussianCloud start_of(const Dataset& dataset, const TrainingConfig& config) {
  const auto points = points_to_start_at(dataset, config.start_gaussians, config.seed);
  GaussianCloud cloud = start_at_points(points, config.start_gaussians, config.start, config.seed);
  print_fact("start", fmt::format("{} of {} {}", grouped(cloud.size()), grouped(points.size()),
                                  dataset.points.empty() ? "random points, the data set brings none"
                                                         : "points of the data set"));
  return cloud;
}

Trainer begun(const std::optional<Checkpoint>& from, const Dataset& dataset,
              const TrainingConfig& config, Photographs& photographs) {
  const double extent = scene_extent(training_cameras(dataset));
  if (from) return {config, photographs, extent, Trainer::restored(from->state)};
  return {config, photographs, extent, start_of(dataset, config)};
}

int run(const TrainArguments& arguments) {
  check_output_name(arguments.out, ".ply");
  OutputPlan plan;
  arguments.add_to(plan);
  plan.check();
  const Dataset dataset = arguments.data.open(plan);
  const TrainingConfig config = training_config(arguments);
  const std::string contents = arguments.contents(plan);
  const std::optional<Checkpoint> from = arguments.resumed(arguments.training(), contents);
  Photographs train(dataset, Split::kTrain), test(dataset, Split::kTest);
  Trainer trainer = begun(from, dataset, config, train);
  test.load(1);
  if (config.background != Background::kRandom && !test.transparent()) {
    throw InputError(
        fmt::format("--background: got {}, but nothing is seen behind opaque photographs",
                    arguments.background));
  }
  // As pictures of transparent objects are compared.
  const glm::vec3 background(test.transparent() ? 1.0F : 0.0F);
  arguments.pictures.write_photographs(test, background);
  const auto look = [&] {
    const PictureSeen seen = arguments.pictures.behind(trainer.next_step());
    return Look{mean_quality(qualities(trainer.activated(), test, background, seen)), {}};
  };
  const auto write = [&] { write_ply(arguments.out, trainer.cloud()); };
  const FittingTask task{arguments.training(), "", contents, trainer, {}, look, write};
  return run_fitting(arguments, task, from, false);
}

}  // namespace

SubCommand add_train_command(CommandLine& line, const Kinds&) {
  auto arguments = std::make_shared<TrainArguments>();
  line.file("DATASET", arguments->data.folder, "the folder of a data set", Given::kAlways);
  arguments->data.add_options_to(line);
  arguments->add_to(line, "scene to write: .ply");
  line.whole("--steps", arguments->steps, 1, 1'000'000, "of training, a photograph each");
  line.whole("--gaussians", arguments->gaussians, 1, 100'000'000, "at most");
  line.whole("--seed", arguments->seed, 0, kMostSeed, "of all that is drawn by lot");
  line.whole("--sh-degree", arguments->sh_degree, 0, 3, "of colours");
  line.one_of({"mcmc", "original"}, "--growth", arguments->growth, "where Gaussians come and go");
  line.one_of({"random", "white", "black"}, "--background", arguments->background,
              "behind transparent photographs");
  return [arguments] { return run(*arguments); };
}

}  // namespace sgs
