// streaminggs pack SCENE --out FILE.sgs
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "algorithm/input_error.h"
#include "algorithm/memory/decoded_image.h"
#include "algorithm/memory/image_file.h"
#include "algorithm/output_file.h"
#include "testbench/streaminggs/commands.h"
#include "testbench/streaminggs/config_arguments.h"
#include "testbench/streaminggs/describe_packed.h"
#include "testbench/streaminggs/packed_config.h"
#include "testbench/streaminggs/prepared_scene.h"
#include "testbench/streaminggs/scene_arguments.h"

namespace sgs {
namespace {

struct Arguments : SceneArguments, ConfigArguments {
  std::string out;
};

// Throws InputError for what a reader of the file would refuse: scales beyond float, for example.
void check_records(const MemoryImage& image, const std::string& scene) {
  std::vector<std::uint32_t> slots(image.layout.gaussian_count);
  std::iota(slots.begin(), slots.end(), 0U);
  decode_image(image, slots, scene);
}

int run(const Arguments& arguments) {
  const auto began = std::chrono::steady_clock::now();
  if (!is_image_file(arguments.out)) {
    throw InputError(fmt::format("--out: {}, expected a name that ends in {}", arguments.out,
                                 kImageFileExtension));
  }
  { const OutputFile place(arguments.out); }  // refused before the work, not behind it
  AcceleratorConfig config = arguments.given_config();
  std::vector<AutoChoice> chosen;
  resolve(config, chosen);
  Scene scene = arguments.load();
  const std::vector<Camera> weighing = arguments.weighing_cameras(scene.cameras);
  const PreparedScene prepared(std::move(scene), config, weighing);
  check_records(prepared.image(), arguments.scene);
  const PackedFacts facts = packed_facts(config, prepared.image(), prepared.name(),
                                         prepared.gaussians(), prepared.dropped_invalid());
  write_image_file(arguments.out, facts, prepared.image());
  print_packed(facts, prepared.image().layout);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
  fmt::print("{:<26}{} B, {}\n", "file", std::filesystem::file_size(arguments.out), arguments.out);
  fmt::print("{:<26}{:.1f} s\n", "packed in", took.count());
  return 0;
}

}  // namespace

SubCommand add_pack_command(CLI::App& app) {
  auto arguments = std::make_shared<Arguments>();
  arguments->add_scene_to(app);
  app.add_option("--cameras", arguments->cameras_path,
                 "cameras.json, for vector quantisation; built-in scenes bring their own");
  arguments->add_weighing_to(app);
  arguments->add_config_to(app);
  app.add_option("--out", arguments->out, "file to write, .sgs")->required();
  return [arguments] { return run(*arguments); };
}

}  // namespace sgs
