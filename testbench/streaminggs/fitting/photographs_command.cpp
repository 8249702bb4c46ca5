// streaminggs photographs DATASET --out FOLDER
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "algorithm/files/input_error.h"
#include "algorithm/files/output_file.h"
#include "algorithm/image/image_io.h"
#include "algorithm/scene/camera.h"
#include "algorithm/train/photographs.h"
#include "testbench/streaminggs/commands.h"
#include "testbench/streaminggs/fitting/dataset_arguments.h"
#include "testbench/streaminggs/report/numbers.h"

namespace sgs {
namespace {

struct PhotographsArguments {
  DatasetArguments data;
  std::string out;

  std::string file(const std::string& name) const {
    return (std::filesystem::path(out) / name).string();
  }
  std::string cameras() const { return file("cameras.json"); }
  std::string picture(std::size_t view) const { return file(fmt::format("view_{}.exr", view)); }
};

int run(const PhotographsArguments& arguments) {
  OutputPlan plan;
  const Dataset dataset = arguments.data.open(plan);
  Photographs test(dataset, Split::kTest);
  plan.add_output(arguments.cameras());
  for (std::size_t at = 0; at < test.size(); ++at) plan.add_output(arguments.picture(at));
  plan.check();
  std::error_code not_there;
  if (std::filesystem::equivalent(arguments.out, dataset.folder, not_there)) {
    throw InputError("--out: " + arguments.out +
                     " is the data set itself, which cameras.json would give a second layout, "
                     "expected another folder");
  }
  test.load(1);
  std::vector<Camera> cameras;
  for (std::size_t at = 0; at < test.size(); ++at) {
    cameras.push_back(test.camera(at));
    write_image(arguments.picture(at), test.before(at, glm::vec3(0)));
  }
  // Behind the pictures: whoever finds it finds them all.
  write_cameras(arguments.cameras(), cameras);
  fmt::print("{} test views written to {}\n", grouped(test.size()), arguments.out);
  return 0;
}

}  // namespace

SubCommand add_photographs_command(CommandLine& line, const Kinds&) {
  auto arguments = std::make_shared<PhotographsArguments>();
  line.file("DATASET", arguments->data.folder, "the folder of a data set", Given::kAlways);
  arguments->data.add_options_to(line);
  line.file("--out", arguments->out,
            "folder for cameras.json of its test views and view_N.exr, the photographs before "
            "black, as machines draw",
            Given::kAlways);
  return [arguments] { return run(*arguments); };
}

}  // namespace sgs
