// streaminggs tune SCENE --boundary|--quantise|--streaming --out FILE
#include "testbench/streaminggs/fitting/tune_command.h"

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "algorithm/files/input_error.h"
#include "algorithm/files/output_file.h"
#include "algorithm/splat/activate.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/storage/storage_scheme.h"
#include "algorithm/train/photographs.h"
#include "testbench/streaminggs/commands.h"
#include "testbench/streaminggs/report/numbers.h"
#include "testbench/streaminggs/run/prepared_scene.h"

namespace sgs {

namespace {

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
  arguments.check();
  RunConfig config = read_run_config(arguments.config, kinds);
  if (config.storage.sh_tolerance > 0) {
    throw InputError(fmt::format("storage.sh_tolerance: got {}, expected 0: tune keeps all bands",
                                 config.storage.sh_tolerance));
  }
  OutputPlan plan;
  arguments.add_inputs_to(plan);
  plan.add_input(arguments.config.path());
  if (!arguments.target.empty()) {
    for (const std::string& file : files_of_scene(arguments.target, arguments.reading())) {
      plan.add_input(file);
    }
  }
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

TuningViews views_of_dataset(Dataset given) {
  auto dataset = std::make_unique<const Dataset>(std::move(given));
  std::vector<Camera> cameras;
  for (const int view : views_of(*dataset, Split::kTrain)) {
    cameras.push_back(dataset->views[static_cast<std::size_t>(view)].camera);
  }
  Photographs tune(*dataset, Split::kTrain), test(*dataset, Split::kTest);
  tune.load(1);
  test.load(1);
  std::string says = fmt::format("{} photographs of {}, {} others to test with",
                                 grouped(tune.size()), dataset->folder, grouped(test.size()));
  return {std::move(dataset), std::move(cameras), std::move(tune), std::move(test),
          std::move(says)};
}

TuningViews views_of_scene(const std::string& pictures, const ActivatedCloud& cloud,
                           const std::vector<Camera>& cameras, std::uint32_t between,
                           std::uint64_t seed) {
  constexpr std::size_t kTestEvery = 8;
  std::vector<Camera> tune, test;
  if (between > 0) {
    test = cameras;
    tune = cameras_between(cameras, between, seed);
  } else {
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      (i % kTestEvery == 0 ? test : tune).push_back(cameras[i]);
    }
    if (tune.empty()) tune = test;
  }
  const bool alone = between == 0 && cameras.size() == 1;
  TuningViews out{nullptr, tune, own_pictures(cloud, tune), own_pictures(cloud, test), ""};
  out.tune.load(1);
  out.test.load(1);
  out.says = fmt::format("no photographs: {}, {} views{}, {} to test with", pictures,
                         grouped(tune.size()), between > 0 ? " between the cameras" : "",
                         alone ? "the same one" : grouped(test.size()));
  return out;
}

std::vector<PixelSize> frame_sizes(const TuningViews& views) {
  std::vector<PixelSize> sizes;
  for (const Camera& camera : views.cameras) sizes.push_back({camera.width, camera.height});
  return sizes;
}

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
  if (order && order->parts > 1 && in_16_bits(order->precision)) {
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
  print_fact("target", job.views.says);
  print_fact("Gaussians",
             fmt::format("{} in {}, {} left out that no view can show", grouped(gaussians),
                         scheme_of(storage.order).in_words(storage),
                         grouped(job.scene.cloud.size() - gaussians)));
}

void print_visits(const VisitPlan& plan) {
  print_fact("visits", fmt::format("{:.1f} MB kept", static_cast<double>(plan.kept_bytes()) / 1e6));
}

SubCommand add_tune_command(CommandLine& line, const Kinds& kinds) {
  auto arguments = std::make_shared<TuneArguments>();
  arguments->view = "all";
  arguments->config.config = "paper";
  arguments->add_to(line);
  return [arguments, &kinds] { return run(*arguments, kinds); };
}

}  // namespace sgs
