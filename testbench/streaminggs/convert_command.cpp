// streaminggs convert SCENE OUT.ply
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>

#include "algorithm/files/input_error.h"
#include "algorithm/files/output_file.h"
#include "algorithm/scene/ply_writer.h"
#include "testbench/streaminggs/commands.h"
#include "testbench/streaminggs/report/numbers.h"
#include "testbench/streaminggs/run/scene_arguments.h"

namespace sgs {
namespace {

struct ConvertArguments : SceneArguments {
  std::string out;
};

int run(const ConvertArguments& arguments) {
  if (std::filesystem::path(arguments.out).extension() != ".ply") {
    throw InputError(fmt::format("{}, expected a name that ends in .ply", arguments.out));
  }
  OutputPlan plan;
  arguments.add_inputs_to(plan);
  plan.add_output(arguments.out);
  plan.check();
  const Scene scene = arguments.load();
  write_ply(arguments.out, scene.cloud);
  if (scene.dropped_invalid > 0) {
    fmt::print("dropped invalid: {} Gaussians\n", grouped(scene.dropped_invalid));
  }
  fmt::print("{}: {} Gaussians of SH degree {}, {} B\n", arguments.out, grouped(scene.cloud.size()),
             scene.cloud.sh_degree, grouped(std::filesystem::file_size(arguments.out)));
  return 0;
}

}  // namespace

SubCommand add_convert_command(CommandLine& line, const Kinds& /*kinds*/) {
  auto arguments = std::make_shared<ConvertArguments>();
  arguments->add_scene_to(line, kUnpackedSceneForms);
  line.text("OUT", arguments->out, "file to write: .ply as the original code writes it",
            Given::kAlways);
  return [arguments] { return run(*arguments); };
}

}  // namespace sgs
