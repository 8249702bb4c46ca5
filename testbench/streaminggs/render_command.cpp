// streaminggs render SCENE --out FILE
#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "algorithm/image/image_io.h"
#include "algorithm/input_error.h"
#include "algorithm/render/reference_renderer.h"
#include "algorithm/splat/activate.h"
#include "algorithm/storage/restore_scene.h"
#include "testbench/streaminggs/commands.h"
#include "testbench/streaminggs/prepared_scene.h"
#include "testbench/streaminggs/scene_arguments.h"

namespace sgs {
namespace {

struct Arguments : SceneArguments {
  std::string out;
  std::string ordering = "reference";
  std::vector<std::string> overrides;

  Camera camera(const std::vector<Camera>& own) const {
    const auto views = cameras(own);
    if (views.size() == 1) return views.front().second;
    throw InputError(
        fmt::format("--view: '{}' names {} views, expected one for one image", view, views.size()));
  }
};

void render_reference_picture(const Arguments& arguments) {
  Scene scene;
  ActivatedCloud cloud;
  if (auto packed = arguments.load_packed()) {
    cloud = restore_scene(std::move(*packed), arguments.scene).decoded;
  } else {
    scene = arguments.load();
    cloud = activate(scene.cloud);
  }
  const View<float> view = make_view<float>(arguments.camera(scene.cameras));
  write_image(arguments.out, render_reference(view, cloud).image);
}

// The picture that a machine must give, and what its order loses.
void render_golden_picture(const Arguments& arguments, const Kinds& kinds) {
  ConfigDocument document;
  document.add_override("machine=" + arguments.ordering);
  for (const std::string& assignment : arguments.overrides) document.add_override(assignment);
  RunConfig config = read_run_config(document, kinds);
  Scene scene;
  PreparedScene prepared;
  if (auto packed = arguments.load_packed()) {
    resolve(config, *packed, arguments.scene);
    prepared = prepare(std::move(*packed), arguments.scene, config);
  } else {
    resolve(config);
    scene = arguments.load();
    prepared = prepare(scene, config, arguments.weighing_cameras(scene.cameras));
  }
  const FrameJob job = config.design->job(prepared.stored, arguments.camera(scene.cameras));
  const StreamingResult result = config.design->golden(prepared.stored, job);
  write_image(arguments.out, result.frame.image);
  fmt::print("missed {} (group, splat) pairs\nmisordered {} of {} blends\n", result.stats.missed,
             result.stats.misordered, result.stats.contributors);
}

}  // namespace

SubCommand add_render_command(CommandLine& line, const Kinds& kinds) {
  auto arguments = std::make_shared<Arguments>();
  arguments->add_scene_to(line);
  arguments->add_views_to(line);
  line.text("--out", arguments->out, "image: .exr, .pfm or .png", Given::kAlways);
  std::vector<std::string> orderings = {arguments->ordering};
  for (const MachineKind& kind : kinds) orderings.emplace_back(kind.name);
  line.one_of(orderings, "--ordering", arguments->ordering,
              "the reference renderer, or the picture that a machine must give");
  line.texts("--set", arguments->overrides, "key.path=value of the machine's configuration");
  return [arguments, &kinds] {
    check_image_name(arguments->out);
    OutputPlan plan;
    arguments->add_inputs_to(plan);
    plan.add_output(arguments->out);
    plan.check();
    if (arguments->ordering == "reference") {
      render_reference_picture(*arguments);
    } else {
      render_golden_picture(*arguments, kinds);
    }
    return 0;
  };
}

}  // namespace sgs
