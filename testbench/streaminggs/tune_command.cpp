// streaminggs tune SCENE --boundary|--quantise|--streaming --out FILE
#include "testbench/streaminggs/tune_command.h"

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "algorithm/input_error.h"
#include "algorithm/output_plan.h"
#include "algorithm/splat/activate.h"
#include "algorithm/splat/reorder.h"
#include "algorithm/storage/image_file.h"
#include "algorithm/storage/storage_scheme.h"
#include "testbench/streaminggs/commands.h"
#include "testbench/streaminggs/numbers.h"
#include "testbench/streaminggs/prepared_scene.h"

namespace sgs {
namespace {

void check_arguments(const TuneArguments& arguments) {
  const int purposes =
      (arguments.boundary ? 1 : 0) + (arguments.quantise ? 1 : 0) + (arguments.streaming ? 1 : 0);
  if (purposes != 1) {
    throw InputError(
        fmt::format("tune: got {} to tune for, expected one of --boundary, --quantise, --streaming",
                    purposes == 0 ? "nothing" : "several things"));
  }
  arguments.check_extension(arguments.quantise ? kImageFileExtension : ".ply");
  if (arguments.data.folder.empty()) return;
  const std::pair<const char*, bool> of_cameras[] = {{"--cameras", !arguments.cameras_path.empty()},
                                                     {"--size", !arguments.size.empty()},
                                                     {"--between", arguments.between > 0},
                                                     {"--target", !arguments.target.empty()}};
  for (const auto& [name, given] : of_cameras) {
    if (given) throw InputError(fmt::format("{}: the data set brings its views", name));
  }
}

TuningViews views_for(const TuneArguments& arguments, const Scene& scene, OutputPlan& plan) {
  if (!arguments.data.folder.empty()) return views_of_dataset(arguments.data.open(plan));
  SceneArguments shown = arguments;
  std::optional<Scene> other;
  if (!arguments.target.empty()) {
    shown.scene = arguments.target;
    other = shown.load();
  }
  const Scene& target = other ? *other : scene;
  std::vector<Camera> cameras;
  for (auto& [number, camera] : shown.cameras(target.cameras)) cameras.push_back(camera);
  if (arguments.between > 0 && cameras.size() < 2) {
    throw InputError("--between: got one camera, expected two or more");
  }
  const std::string pictures =
      other ? "reference pictures of " + arguments.target : "the scene's own reference pictures";
  return views_of_scene(pictures, activate(target.cloud), cameras, arguments.between,
                        arguments.seed);
}

int run(const TuneArguments& arguments, const Kinds& kinds) {
  check_arguments(arguments);
  RunConfig config = read_run_config(arguments.config.document(), kinds);
  OutputPlan plan;
  arguments.add_inputs_to(plan);
  plan.add_input(arguments.config.path());
  plan.add_input(arguments.target);
  arguments.FittingArguments::add_to(plan);
  plan.check();
  Scene scene = arguments.load();
  TuningViews views = views_for(arguments, scene, plan);
  TuningJob job{std::move(scene), std::move(views), std::move(config), arguments.contents(plan)};
  job.config.design->fit_frames([&] { return frame_sizes(job.views); });
  resolve(job.config);
  adapt(job.config, job.scene);
  if (arguments.boundary) return tune_for_boundaries(arguments, job);
  return arguments.quantise ? tune_for_codebooks(arguments, job)
                            : tune_for_streaming(arguments, job);
}

}  // namespace

CloudInStorage in_storage(const GaussianCloud& cloud, const StorageConfig& storage) {
  auto [table, order] = scheme_of(storage.order).arrange(activate(cloud), storage);
  return {std::move(table), reordered(cloud, order)};
}

CloudInStorage given_in_storage(const TuneArguments& arguments, const TuningJob& job) {
  CloudInStorage given = in_storage(job.scene.cloud, job.config.storage);
  if (given.cloud.size() == 0) {
    throw InputError(arguments.scene + ": holds no Gaussian that a view could show");
  }
  return given;
}

std::optional<PaperOrderConfig> tuned_order(const TuneArguments& arguments,
                                            const RunConfig& config) {
  std::optional<PaperOrderConfig> order = config.design->paper_order();
  if (!order && !config.design->draws_reference()) {
    throw InputError(fmt::format(
        "--{}: machine {} as it is configured draws neither paper order nor the reference "
        "picture, expected rendering.precision fp32 and nothing that is given up",
        arguments.purpose(), config.machine()));
  }
  if (!order && arguments.visit_memory_mb != TuneArguments::kVisitMemoryMb) {
    throw InputError("--visit-memory: only paper order has visits");
  }
  if (order && order->parts > 1 && order->precision == BlendPrecision::kHalf) {
    throw InputError(
        "fetch: shared with rendering.precision fp16 filters each part of a group by itself, "
        "expected split, or fp32");
  }
  return order;
}

SceneTuner begun_tuner(const TuneArguments& arguments, const TuningJob& job,
                       const TuningConfig& config, DrawingOrder order, Penalty penalty,
                       const GaussianCloud& given, const std::optional<Checkpoint>& from) {
  if (!from) {
    return {config, job.views.tune, std::move(order), std::move(penalty), given};
  }
  SceneTuner::State state = SceneTuner::restored(from->state);
  if (state.cloud.means != given.means) {
    throw InputError(fmt::format("{}: is of another scene than {}, its centres are others",
                                 arguments.resume, arguments.scene));
  }
  return {config, job.views.tune, std::move(order), std::move(penalty), std::move(state)};
}

void print_target(const TuningJob& job, std::size_t gaussians) {
  const StorageConfig& storage = job.config.storage;
  fmt::print("{:<26}{}\n{:<26}{} in {}, {} left out that no view can show\n", "target",
             job.views.says, "Gaussians", grouped(gaussians),
             scheme_of(storage.order).in_words(storage),
             grouped(job.scene.cloud.size() - gaussians));
}

void print_visits(const VisitPlan& plan) {
  fmt::print("{:<26}{:.1f} MB kept\n", "visits", static_cast<double>(plan.kept_bytes()) / 1e6);
}

void TuneArguments::set(TuningConfig& tuning, int own_steps, double own_rate) const {
  tuning.steps = steps > 0 ? static_cast<int>(steps) : own_steps;
  tuning.rate = rate > 0 ? rate : own_rate;
  tuning.seed = seed;
  tuning.comparison.gradients = gradient_rule();
}

std::string TuneArguments::work(const TuningConfig& tuning) const {
  std::string line = fmt::format("tune {} --{} --config {}", scene, purpose(), config.config);
  for (const std::string& value : config.overrides) line += " --set " + value;
  if (data.folder.empty()) {
    line += fmt::format(" --cameras {} --size {} --between {}", cameras_path, size, between);
    if (!target.empty()) line += " --target " + target;
  } else {
    line += " --data " + data.work();
  }
  line += fmt::format(" --steps {} --seed {} --rate {} --gradients {}", tuning.steps, seed,
                      tuning.rate, gradients);
  if (quantise) return line + fmt::format(" --reassign-every {}", reassign_every);
  if (streaming) return line + fmt::format(" --price {}", price);
  return line + fmt::format(" --beta {} --misordered-in {} --penalty-mean {}", beta, misordered_in,
                            penalty_mean);
}

SubCommand add_tune_command(CommandLine& line, const Kinds& kinds) {
  auto arguments = std::make_shared<TuneArguments>();
  arguments->view = "all";
  arguments->config.config = "paper";
  arguments->add_scene_to(line, kUnpackedSceneForms);
  line.flag("--boundary", arguments->boundary,
            "for paper order: less that is blended out of order; centres rest");
  line.flag("--quantise", arguments->quantise,
            "for codebooks: entries and Gaussians learned together; centres rest");
  line.flag("--streaming", arguments->streaming,
            "for fewer bytes in exact order: Gaussians pay for what they are fetched for; centres "
            "rest");
  line.file("--data", arguments->data.folder,
            "the folder of a data set; without, the scene's own "
            "reference pictures are what it is to look like");
  arguments->data.add_downscale_to(line);
  line.needs("--downscale", "--data");
  line.text("--target", arguments->target,
            "the scene whose reference pictures these are, where it is not SCENE itself: what "
            "SCENE was before it was tuned");
  line.file(
      "--cameras", arguments->cameras_path,
      "cameras.json of these pictures, every eighth to test with; built-in scenes bring their "
      "own, others need it: none are made out of nothing");
  line.text("--size", arguments->size, "WIDTHxHEIGHT in px; scales the intrinsics");
  line.whole("--between", arguments->between, 0, 100'000,
             "so many cameras made to tune on, those given all to test with: each between two of "
             "them drawn by lot, on the line between the centres, turned the shortest way");
  arguments->config.add_to(line);
  arguments->FittingArguments::add_to(line, "scene to write: .sgs with --quantise, else .ply");
  line.whole("--steps", arguments->steps, 0, 1'000'000,
             "a picture each; 0: 3,000, with --quantise 5,000");
  line.whole("--seed", arguments->seed, 0, kMostSeed, "of all that is drawn by lot");
  line.real("--rate", arguments->rate, 0, 1'000,
            "of learning, times the original's; 0: 1, with --quantise and --streaming 0.2");
  line.real("--beta", arguments->beta, 0, 1e9, "of L_CBP in the loss");
  line.one_of({"group", "pixel"}, "--misordered-in", arguments->misordered_in,
              "where a Gaussian comes behind a farther one: in its group or at a pixel of its own");
  line.one_of({"rendered", "scene"}, "--penalty-mean", arguments->penalty_mean,
              "what L_CBP is a mean over: (group, Gaussian) pairs or all Gaussians");
  line.whole("--reassign-every", arguments->reassign_every, 1, 1'000'000,
             "steps: every Gaussian finds its nearest entries anew");
  for (const char* name : {"--beta", "--misordered-in", "--penalty-mean"}) {
    line.needs(name, "--boundary");
  }
  line.needs("--reassign-every", "--quantise");
  line.real("--price", arguments->price, 0, 1e9, "of a fetch in the loss");
  line.needs("--price", "--streaming");
  line.whole("--visit-memory", arguments->visit_memory_mb, 0, 1'000'000,
             "MB of visits that are kept; those of further views are made anew each time");
  return [arguments, &kinds] { return run(*arguments, kinds); };
}

}  // namespace sgs
