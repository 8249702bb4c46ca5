// streaminggs render SCENE --out FILE
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "algorithm/files/input_error.h"
#include "algorithm/image/image_io.h"
#include "algorithm/render/reference_renderer.h"
#include "algorithm/splat/activate.h"
#include "algorithm/storage/stored_scene.h"
#include "testbench/command_line/config_source.h"
#include "testbench/streaminggs/commands.h"
#include "testbench/streaminggs/run/prepared_scene.h"
#include "testbench/streaminggs/run/scene_arguments.h"

namespace sgs {
namespace {

constexpr const char* kReference = "reference";

struct RenderArguments : SceneArguments {
  std::string out;
  std::string ordering = kReference;
  ConfigSource config;

  Camera camera(const std::vector<Camera>& own) const {
    const auto views = cameras(own);
    if (views.size() == 1) return views.front().second;
    throw InputError(
        fmt::format("--view: '{}' names {} views, expected one for one image", view, views.size()));
  }
};

// Without --config the preset of the ordering's name, where there is one.
ConfigSource completed(ConfigSource config, const std::string& ordering) {
  if (!config.config.empty()) return config;
  config.config = ordering;
  if (config.is_preset()) return config;
  config.config.clear();
  config.overrides.insert(config.overrides.begin(), "machine=" + ordering);
  return config;
}

// contributes: whether any Gaussian does.
void say_what_was_drawn(const std::string& out, bool contributes) {
  if (!contributes) fmt::print("no Gaussian contributes to the picture\n");
  fmt::print("written to {}\n", out);
}

void render_reference_picture(const RenderArguments& arguments) {
  Scene scene;
  ActivatedCloud cloud;
  if (auto packed = arguments.load_packed()) {
    cloud = restore_scene(std::move(*packed), arguments.scene).decoded;
  } else {
    scene = arguments.load();
    cloud = activate(scene.cloud);
  }
  const View<float> view = make_view<float>(arguments.camera(scene.cameras));
  const RenderResult drawn = render_reference(view, cloud);
  write_image(arguments.out, drawn.image);
  say_what_was_drawn(arguments.out,
                     std::any_of(drawn.contributors.begin(), drawn.contributors.end(),
                                 [](std::uint32_t splats) { return splats > 0; }));
}

// The picture that a machine must give, and what its order loses.
void render_golden_picture(const RenderArguments& arguments, const Kinds& kinds) {
  RunConfig config = read_run_config(arguments.config, kinds);
  if (config.machine() != arguments.ordering) {
    throw InputError(
        fmt::format("--ordering {}: the configuration is of machine {}, expected one "
                    "of machine {}",
                    arguments.ordering, config.machine(), arguments.ordering));
  }
  config.design->fit_frames([&] { return arguments.frame_sizes(); });
  Scene scene;
  PreparedScene prepared;
  if (auto packed = arguments.load_packed()) {
    resolve(config, *packed, arguments.scene, arguments.config.preset_in_words());
    prepared = prepare(std::move(*packed), arguments.scene, config);
  } else {
    resolve(config);
    scene = arguments.load();
    prepared =
        prepare(scene, config, arguments.weighing_cameras(scene.cameras, config.storage.encoding));
  }
  const FrameJob job = config.design->job(prepared.stored, arguments.camera(scene.cameras));
  DataSheet unread;
  const GoldenFrame golden = config.design->golden(prepared.stored, job, unread);
  write_image(arguments.out, golden.image);
  fmt::print("missed {} (group, splat) pairs\nmisordered {} of {} blends\n", golden.missed,
             golden.misordered, golden.blends);
  say_what_was_drawn(arguments.out, golden.contributing > 0);
}

}  // namespace

SubCommand add_render_command(CommandLine& line, const Kinds& kinds) {
  auto arguments = std::make_shared<RenderArguments>();
  arguments->add_scene_to(line);
  arguments->add_views_to(line);
  line.text("--out", arguments->out, "image: .exr, .pfm or .png", Given::kAlways);
  std::vector<std::string> orderings = {arguments->ordering};
  for (const MachineKind& kind : kinds) orderings.emplace_back(kind.name);
  line.one_of(orderings, "--ordering", arguments->ordering,
              "the reference renderer, or the picture that a machine must give");
  arguments->config.add_to(line, "; if not given, the one of the ordering's name");
  arguments->config.add_fitting_to(line);
  return [arguments, &kinds] {
    const bool reference = arguments->ordering == kReference;
    const ConfigSource& given = arguments->config;
    if (reference && !(given.config.empty() && given.overrides.empty() && !given.fit_memories)) {
      throw InputError(
          "--config, --set, --fit-memories: the reference renderer has nothing to configure, "
          "expected "
          "them with the --ordering of a machine");
    }
    if (!reference) arguments->config = completed(arguments->config, arguments->ordering);
    check_image_name(arguments->out);
    OutputPlan plan;
    arguments->add_inputs_to(plan);
    plan.add_input(arguments->config.path());
    plan.add_output(arguments->out);
    plan.check();
    if (reference) {
      render_reference_picture(*arguments);
    } else {
      render_golden_picture(*arguments, kinds);
    }
    return 0;
  };
}

}  // namespace sgs
