#include "testbench/streaminggs/fitting/dataset_arguments.h"

#include <fmt/format.h>

#include "algorithm/dataset/dataset.h"
#include "testbench/command_line/while_doing.h"

namespace sgs {

void DatasetArguments::add_downscale_to(CommandLine& line) {
  line.real("--downscale", downscale, 1, 1'000,
            "photographs and cameras so many times smaller, as 2 of 800 px makes 400; sides are "
            "rounded");
}

std::string DatasetArguments::work() const {
  return downscale == 1 ? folder : fmt::format("{} --downscale {}", folder, downscale);
}

Dataset DatasetArguments::open(OutputPlan& plan) const {
  Dataset dataset =
      while_doing("reading " + folder, [&] { return open_dataset(folder, downscale); });
  require_test_views(dataset);
  for (const std::string& file : dataset.files) plan.add_input(file);
  for (const DatasetView& view : dataset.views) plan.add_input(view.image_path);
  plan.check();
  return dataset;
}

}  // namespace sgs
