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
#include "testbench/streaminggs/commands.h"
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

SubCommand add_tune_command(CommandLine& line, const Kinds& kinds) {
  auto arguments = std::make_shared<TuneArguments>();
  arguments->view = "all";
  arguments->config.config = "paper";
  arguments->add_to(line);
  return [arguments, &kinds] { return run(*arguments, kinds); };
}

}  // namespace sgs
