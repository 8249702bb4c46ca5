// The lines of describe_dataset.h.
#include "testbench/streaminggs/fitting/describe_dataset.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/common.hpp>
#include <map>
#include <string>
#include <utility>

#include "testbench/streaminggs/report/numbers.h"

namespace sgs {
namespace {

void print(const char* name, const std::string& value) { fmt::print("{:<26}{}\n", name, value); }

std::string corners_of(const Extent& extent) {
  return fmt::format("{:.4g} {:.4g} {:.4g} .. {:.4g} {:.4g} {:.4g} (world units)", extent.min.x,
                     extent.min.y, extent.min.z, extent.max.x, extent.max.y, extent.max.z);
}

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
  print("data set", dataset.layout);
  print("views", std::to_string(dataset.views.size()));
  print("to train from", std::to_string(views_of(dataset, Split::kTrain).size()));
  print("to test with",
        fmt::format("{} ({})", views_of(dataset, Split::kTest).size(),
                    dataset.split_by == SplitBy::kDataset ? "the data set's own split"
                                                          : "every 8th by name"));
  if (dataset.left_out > 0) {
    print("left out", fmt::format("{} (for validation)", dataset.left_out));
  }
  print("size", sizes(dataset));
  if (const int beside = count_if(dataset, [](const DatasetView& view) {
        return view.camera.principal_offset != glm::dvec2(0);
      })) {
    print("principal point", fmt::format("beside the middle in {} views", beside));
  }
  print("with alpha", std::to_string(count_if(
                          dataset, [](const DatasetView& view) { return view.file.has_alpha; })));
  print("points", grouped(dataset.points.size()));
  print("cameras stand in", corners_of(box_of_cameras(dataset)));
  if (dataset.bounds) print("bounds", corners_of(*dataset.bounds));
  print_notes(dataset);
}

void print_notes(const Dataset& dataset) {
  for (const auto& [title, text] : dataset.notes) print(title.c_str(), text);
}

}  // namespace sgs
