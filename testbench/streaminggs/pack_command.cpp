// streaminggs pack SCENE --out FILE.sgs|.ply
#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "algorithm/files/input_error.h"
#include "algorithm/files/output_file.h"
#include "algorithm/scene/ply_writer.h"
#include "algorithm/splat/activate.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/storage/decoded_image.h"
#include "algorithm/storage/image_file.h"
#include "modules/dram/memspec.h"
#include "testbench/command_line/config_source.h"
#include "testbench/streaminggs/commands.h"
#include "testbench/streaminggs/describe_packed.h"
#include "testbench/streaminggs/report/numbers.h"
#include "testbench/streaminggs/run/prepared_scene.h"
#include "testbench/streaminggs/run/scene_arguments.h"

namespace sgs {
namespace {

struct PackArguments : SceneArguments {
  ConfigSource config;
  std::string out;
};

// Throws InputError for what a reader of the file would refuse: scales beyond float, for example.
void check_records(const MemoryImage& image, const std::string& scene) {
  decode_image(image, scene);
}

bool is_ply(const std::string& path) { return std::filesystem::path(path).extension() == ".ply"; }

// The stored Gaussians by slot, as in the scene's file; decoded where the encoding is lossy.
GaussianCloud stored_cloud(const GaussianCloud& in_file, const StoredScene& stored) {
  return stored.original ? deactivate(stored.decoded) : reordered(in_file, *stored.file_indices);
}

int run(const PackArguments& arguments, const Kinds& kinds) {
  const auto began = std::chrono::steady_clock::now();
  const bool as_ply = is_ply(arguments.out);
  if (!as_ply && !is_image_file(arguments.out)) {
    throw InputError(fmt::format("--out: {}, expected a name that ends in {} or .ply",
                                 arguments.out, kImageFileExtension));
  }
  RunConfig config = read_run_config(arguments.config, kinds);
  OutputPlan plan;
  arguments.add_inputs_to(plan);
  plan.add_input(arguments.config.path());
  plan.add_input(memspec_path(config.dram.memspec));
  plan.add_output(arguments.out);
  plan.check();
  resolve(config);
  const Scene scene = arguments.load();
  const std::vector<Camera> weighing =
      arguments.weighing_cameras(scene.cameras, config.storage.encoding);
  const PreparedScene prepared = prepare(scene, config, weighing, CodebookCache(arguments.cache));
  const MemoryImage& image = prepared.stored.image;
  check_records(image, arguments.scene);
  const PackedFacts facts{prepared.name, prepared.stored.gaussians, prepared.dropped_invalid,
                          prepared.stored.sh_bands_left_out};
  if (as_ply) {
    write_ply(arguments.out, stored_cloud(scene.cloud, prepared.stored), scene.notes);
  } else {
    write_image_file(arguments.out, facts, prepared.stored.storage, image);
  }
  print_packed(facts, prepared.stored.storage, image.layout,
               readers_of(kinds, prepared.stored.storage.order));
  if (image.layout.second_half.quantised()) {
    print_fact("codebooks", weighing.empty()
                                ? std::string("not weighted: no cameras")
                                : fmt::format("weighted by {} cameras", grouped(weighing.size())));
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
  print_fact("file", fmt::format("{} B, {}", grouped(std::filesystem::file_size(arguments.out)),
                                 arguments.out));
  print_fact("packed in", fmt::format("{:.1f} s", took.count()));
  return 0;
}

}  // namespace

SubCommand add_pack_command(CommandLine& line, const Kinds& kinds) {
  auto arguments = std::make_shared<PackArguments>();
  arguments->add_scene_to(line, kUnpackedSceneForms);
  line.file(
      "--cameras", arguments->cameras_path,
      "cameras as render takes them, for vector quantisation; built-in scenes bring their own");
  arguments->add_weighing_to(line);
  arguments->add_cache_to(line);
  arguments->config.config = kinds.front().name;
  arguments->config.add_to(line);
  arguments->config.add_fitting_to(line);
  line.text("--out", arguments->out,
            "file to write: .sgs, or .ply with the Gaussians in storage order", Given::kAlways);
  return [arguments, &kinds] { return run(*arguments, kinds); };
}

}  // namespace sgs
