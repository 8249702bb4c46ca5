#include "testbench/streaminggs/fitting/dataset_arguments.h"

#include <fmt/format.h>

#include "algorithm/dataset/dataset.h"
#include "testbench/command_line/while_doing.h"
#include "testbench/streaminggs/fitting/describe_dataset.h"

namespace sgs {

void DatasetArguments::add_options_to(CommandLine& line) {
  line.real("--downscale", options.downscale, 1, 1'000,
            "photographs and cameras so many times smaller, as 2 of 800 px makes 400; sides are "
            "rounded");
  line.text(
      "--layout", options.layout,
      "colmap, nerf-synthetic, transforms, cameras or nsvf: which of the layouts to read that a "
      "folder holds");
  line.text("--images", options.images,
            "the folder to take photographs from instead of images, as images_4");
}

std::string DatasetArguments::work() const {
  std::string work = folder;
  if (options.downscale != 1) work += fmt::format(" --downscale {}", options.downscale);
  if (!options.layout.empty()) work += " --layout " + options.layout;
  if (!options.images.empty()) work += " --images " + options.images;
  return work;
}

Dataset DatasetArguments::open(OutputPlan& plan) const {
  Dataset dataset = while_doing("reading " + folder, [&] { return open_dataset(folder, options); });
  require_test_views(dataset);
  for (const std::string& file : dataset.files) plan.add_input(file);
  for (const DatasetView& view : dataset.views) {
    plan.add_input(view.image_path);
    plan.add_input(view.mask_path);
  }
  plan.check();
  print_notes(dataset);
  return dataset;
}

}  // namespace sgs
