#include "testbench/streaminggs/fitting/dataset_arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/common.hpp>
#include <map>
#include <string>
#include <utility>

#include "algorithm/dataset/dataset.h"
#include "testbench/command_line/guard.h"
#include "testbench/streaminggs/report/numbers.h"

namespace sgs {

namespace {

// "635x356 px", or each size with how many views have it.
std::string sizes(const Dataset& dataset) {
  std::map<std::pair<int, int>, int> counts;
  for (const DatasetView& view : dataset.views) ++counts[{view.camera.width, view.camera.height}];
  std::string text;
  for (const auto& [size, count] : counts) {
    text += fmt::format("{}{}x{} px", text.empty() ? "" : ", ", size.first, size.second);
    if (counts.size() > 1) text += fmt::format(" ({})", count);
  }
  return text;
}

int count_if(const Dataset& dataset, bool (*holds)(const DatasetView&)) {
  return static_cast<int>(std::count_if(dataset.views.begin(), dataset.views.end(), holds));
}

Extent box_of_cameras(const Dataset& dataset) {
  const glm::vec3 first(dataset.views[0].camera.position);
  Extent box{first, first};
  for (const DatasetView& view : dataset.views) {
    box.min = glm::min(box.min, glm::vec3(view.camera.position));
    box.max = glm::max(box.max, glm::vec3(view.camera.position));
  }
  return box;
}

}  // namespace

void print_dataset(const Dataset& dataset) {
  print_fact("data set", dataset.layout);
  print_fact("views", std::to_string(dataset.views.size()));
  print_fact("to train from", std::to_string(views_of(dataset, Split::kTrain).size()));
  print_fact("to test with",
             fmt::format("{} ({})", views_of(dataset, Split::kTest).size(),
                         dataset.split_by == SplitBy::kDataset ? "the data set's own split"
                                                               : "every 8th by name"));
  if (dataset.left_out > 0) {
    print_fact("left out", fmt::format("{} (for validation)", dataset.left_out));
  }
  print_fact("size", sizes(dataset));
  if (const int beside = count_if(dataset, [](const DatasetView& view) {
        return view.camera.principal_offset != glm::dvec2(0);
      })) {
    print_fact("principal point", fmt::format("beside the middle in {} views", beside));
  }
  print_fact("with alpha", std::to_string(count_if(dataset, [](const DatasetView& view) {
               return view.file.has_alpha;
             })));
  print_fact("points", grouped(dataset.points.size()));
  print_fact("cameras stand in", in_words(box_of_cameras(dataset)));
  if (dataset.bounds) print_fact("bounds", in_words(*dataset.bounds));
  print_notes(dataset);
}

void print_notes(const Dataset& dataset) {
  for (const auto& [title, text] : dataset.notes) print_fact(title, text);
}

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
