// streaminggs convert SCENE --out OUT.ply, or SCENE OUT.ply, and the cameras that the scene brings
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>

#include "algorithm/files/input_error.h"
#include "algorithm/files/output_file.h"
#include "algorithm/scene/camera.h"
#include "algorithm/scene/ply_writer.h"
#include "testbench/streaminggs/commands.h"
#include "testbench/streaminggs/report/numbers.h"
#include "testbench/streaminggs/run/scene_arguments.h"

namespace sgs {
namespace {

struct ConvertArguments : SceneArguments {
  std::string out, second;  // by --out, or behind the scene
  std::string cameras_out;
};

int run(const ConvertArguments& arguments) {
  if (arguments.out.empty() == arguments.second.empty()) {
    throw InputError(fmt::format("--out: got {}, expected one file to write",
                                 arguments.out.empty() ? "none" : "it and " + arguments.second));
  }
  const std::string& out = arguments.out.empty() ? arguments.second : arguments.out;
  if (std::filesystem::path(out).extension() != ".ply") {
    throw InputError(fmt::format("{}, expected a name that ends in .ply", out));
  }
  OutputPlan plan;
  arguments.add_inputs_to(plan);
  plan.add_output(out);
  if (!arguments.cameras_out.empty()) plan.add_output(arguments.cameras_out);
  plan.check();
  const Scene scene = arguments.load();
  if (!arguments.cameras_out.empty()) {
    if (scene.cameras.empty()) {
      throw InputError(fmt::format(
          "--cameras-out: got it with {}, which brings no cameras, expected a built-in scene",
          arguments.scene));
    }
    write_cameras(arguments.cameras_out, scene.cameras);
  }
  write_ply(out, scene.cloud, scene.notes);
  if (scene.dropped_invalid > 0) {
    fmt::print("dropped invalid: {} Gaussians\n", grouped(scene.dropped_invalid));
  }
  fmt::print("{}: {} Gaussians of SH degree {}, {} B\n", out, grouped(scene.cloud.size()),
             scene.cloud.sh_degree, grouped(std::filesystem::file_size(out)));
  return 0;
}

}  // namespace

SubCommand add_convert_command(CommandLine& line, const Kinds& /*kinds*/) {
  auto arguments = std::make_shared<ConvertArguments>();
  arguments->add_scene_to(line, kUnpackedSceneForms);
  line.file("--out", arguments->out, "file to write: .ply as the original code writes it");
  line.file("OUT", arguments->second, "the same without --out");
  line.file("--cameras-out", arguments->cameras_out,
            "the cameras that a built-in scene brings, to be written as cameras.json");
  return [arguments] { return run(*arguments); };
}

}  // namespace sgs
