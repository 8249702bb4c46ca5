// streaminggs train DATASET --out FILE.ply
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "algorithm/dataset/open_dataset.h"
#include "algorithm/input_error.h"
#include "algorithm/output_file.h"
#include "algorithm/output_plan.h"
#include "algorithm/scene/ply_writer.h"
#include "algorithm/train/checkpoint.h"
#include "testbench/command_line/guard.h"
#include "testbench/command_line/interrupt.h"
#include "testbench/command_line/while_doing.h"
#include "testbench/streaminggs/commands.h"
#include "testbench/streaminggs/training_log.h"

namespace sgs {
namespace {

struct TrainArguments {
  std::string dataset, out, log, resume;
  std::string growth = "mcmc";
  std::string background = "random";
  std::uint32_t steps = 20'000, test_every = 1'000, checkpoint_every = 0;
  std::uint64_t gaussians = 100'000;
  std::uint64_t seed = 1;
  std::uint32_t sh_degree = 3;

  std::string checkpoint() const { return out + ".checkpoint"; }
  // What a checkpoint must have been made with.
  std::string training() const {
    return fmt::format(
        "{} --steps {} --gaussians {} --seed {} --sh-degree {} --growth {} "
        "--background {}",
        dataset, steps, gaussians, seed, sh_degree, growth, background);
  }
};

TrainingConfig training_config(const TrainArguments& arguments) {
  TrainingConfig config;
  config.steps = static_cast<int>(arguments.steps);
  config.seed = arguments.seed;
  config.most_gaussians = arguments.gaussians;
  config.start_gaussians = std::min<std::size_t>(config.start_gaussians, arguments.gaussians);
  config.sh_degree = static_cast<int>(arguments.sh_degree);
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
  const auto points = dataset.points.empty()
                          ? random_points(box_to_fill(dataset), config.start_gaussians, config.seed)
                          : dataset.points;
  return start_at_points(points, config.start_gaussians, config.start, config.seed);
}

Checkpoint begun(const TrainArguments& arguments, const Dataset& dataset,
                 const TrainingConfig& config) {
  if (arguments.resume.empty()) {
    GaussianCloud cloud = start_of(dataset, config);
    AdamMoments moments = Adam(cloud).moments();
    const std::size_t count = cloud.size();
    return {arguments.training(),
            "",
            {0, std::move(cloud), std::move(moments), DensificationStatistics(count)}};
  }
  Checkpoint checkpoint = read_checkpoint(arguments.resume);
  if (checkpoint.training != arguments.training()) {
    throw InputError(fmt::format("{}: is of 'train {}', expected 'train {}'", arguments.resume,
                                 checkpoint.training, arguments.training()));
  }
  return checkpoint;
}

class TrainingRun {
 public:
  TrainingRun(const TrainArguments& arguments, const Dataset& dataset, const TrainingConfig& config,
              Checkpoint from)
      : arguments_(arguments),
        train_(dataset, Split::kTrain),
        test_(dataset, Split::kTest),
        log_(config.steps, std::move(from.log)),
        trainer_(config, train_, scene_extent(training_cameras(dataset)), std::move(from.state)) {
    test_.load(1);
  }

  int run() {
    const Interrupt interrupt;
    try {
      while (!trainer_.done()) {
        if (interrupt.wished()) return stopped();
        step();
      }
    } catch (const NotFinite& error) {
      save();
      throw std::runtime_error(
          fmt::format("{}; the state before it is in {}", error.what(), arguments_.checkpoint()));
    }
    write_files();
    return kDone;
  }

 private:
  void step() {
    const Trainer::Step step = trainer_.step();
    log_.tell(step, trainer_.cloud().size());
    const auto every = [&](std::uint32_t steps) {
      return steps > 0 && trainer_.next_step() % static_cast<int>(steps) == 0;
    };
    if (every(arguments_.test_every) || trainer_.done()) {
      // As pictures of transparent objects are compared.
      const glm::vec3 background(test_.transparent() ? 1.0F : 0.0F);
      const auto each = qualities(trainer_.activated(), test_, background);
      log_.add(step, trainer_.cloud().size(), mean_quality(each));
    }
    if (every(arguments_.checkpoint_every) && !trainer_.done()) save();
  }

  void save() const {
    write_checkpoint(arguments_.checkpoint(),
                     {arguments_.training(), log_.csv(), trainer_.state()});
  }

  int stopped() {
    save();
    write_files();
    fmt::print(stderr, "streaminggs train: stopped before step {}; to go on: --resume {}\n",
               trainer_.next_step() + 1, arguments_.checkpoint());
    return kInterrupted;
  }

  void write_files() const {
    if (!arguments_.log.empty()) {
      write_whole_file(arguments_.log, log_.csv().data(), log_.csv().size());
    }
    write_ply(arguments_.out, trainer_.cloud());
  }

  const TrainArguments& arguments_;
  Photographs train_, test_;
  TrainingLog log_;
  Trainer trainer_;
};

int run(const TrainArguments& arguments) {
  OutputPlan plan;
  plan.add_input(arguments.resume);
  plan.add_output(arguments.out);
  if (!arguments.log.empty()) plan.add_output(arguments.log);
  plan.check();
  const Dataset dataset =
      while_doing("reading " + arguments.dataset, [&] { return open_dataset(arguments.dataset); });
  if (views_of(dataset, Split::kTest).empty()) {
    throw InputError(arguments.dataset + ": has no view to test with");
  }
  const TrainingConfig config = training_config(arguments);
  return TrainingRun(arguments, dataset, config, begun(arguments, dataset, config)).run();
}

}  // namespace

SubCommand add_train_command(CommandLine& line, const Kinds&) {
  auto arguments = std::make_shared<TrainArguments>();
  line.file("DATASET", arguments->dataset, "the folder of a data set", Given::kAlways);
  line.file("--out", arguments->out, "scene to write: .ply", Given::kAlways);
  line.file("--log", arguments->log, "steps, loss and quality as CSV");
  line.whole("--steps", arguments->steps, 1, 1'000'000, "of training, a photograph each");
  line.whole("--gaussians", arguments->gaussians, 1, 100'000'000, "at most");
  line.whole("--seed", arguments->seed, 0, kMostSeed, "of all that is drawn by lot");
  line.whole("--sh-degree", arguments->sh_degree, 0, 3, "of colours");
  line.whole("--test-every", arguments->test_every, 1, 1'000'000, "steps: test views are drawn");
  line.whole("--checkpoint", arguments->checkpoint_every, 0, 1'000'000,
             "steps: FILE.ply.checkpoint is written; 0: when stopped by Ctrl-C only");
  line.file("--resume", arguments->resume, "a checkpoint of the same training, to go on from");
  line.one_of({"mcmc", "original"}, "--growth", arguments->growth, "where Gaussians come and go");
  line.one_of({"random", "white", "black"}, "--background", arguments->background,
              "behind transparent photographs");
  return [arguments] { return run(*arguments); };
}

}  // namespace sgs
