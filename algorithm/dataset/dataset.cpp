// The choice of the layout, what all layouts have in common, and the reading of a view's image.
#include "algorithm/dataset/dataset.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <utility>

#include "algorithm/dataset/layouts.h"
#include "algorithm/dataset/view_image.h"
#include "algorithm/files/input_error.h"
#include "algorithm/image/image_io.h"
#include "algorithm/scene/camera.h"

namespace sgs {
namespace {

struct Layout {
  const char* name;
  const char* looked_for;
  bool (*holds)(const std::string& folder);
  StatedDataset (*read)(const std::string& folder);
};

constexpr std::array<Layout, 5> kLayouts = {{
    {"COLMAP", "sparse/0/cameras.bin or .txt", holds_colmap, read_colmap},
    {"NeRF synthetic", "transforms_train.json", holds_split_transforms, read_split_transforms},
    {"transforms.json", "transforms.json", holds_transforms, read_transforms},
    {"cameras.json", "cameras.json", holds_cameras_json, read_cameras_json},
    {"NSVF", "intrinsics.txt with pose and rgb", holds_nsvf, read_nsvf},
}};

const Layout& layout_of(const std::string& folder) {
  std::error_code unknown;
  if (!std::filesystem::is_directory(folder, unknown)) {
    const char* got = std::filesystem::exists(folder, unknown) ? "is a file" : "no such folder";
    throw InputError(fmt::format("{}: {}, expected a folder with a data set", folder, got));
  }
  std::vector<const Layout*> found;
  std::vector<std::string> looked_for, there;
  for (const Layout& layout : kLayouts) {
    looked_for.emplace_back(layout.looked_for);
    if (!layout.holds(folder)) continue;
    found.push_back(&layout);
    there.push_back(looked_for.back());
  }
  if (found.size() == 1) return *found[0];
  throw InputError(fmt::format(
      "{}: {}, expected one of: {}", folder,
      found.empty() ? "holds no data set" : fmt::format("holds {}", join(there, " and ")),
      join(looked_for, ", ")));
}

void refuse_equal_names(const std::vector<StatedView>& by_name) {
  const auto twice =
      std::adjacent_find(by_name.begin(), by_name.end(),
                         [](const StatedView& a, const StatedView& b) { return a.name == b.name; });
  if (twice != by_name.end()) {
    throw InputError(fmt::format("{}: name '{}' a second time, after {}, expected each once",
                                 (twice + 1)->where, twice->name, twice->where));
  }
}

}  // namespace

std::vector<int> views_of(const Dataset& dataset, Split split) {
  std::vector<int> numbers;
  for (const DatasetView& view : dataset.views) {
    if (view.split == split) numbers.push_back(view.camera.id);
  }
  return numbers;
}

Dataset open_dataset(const std::string& folder, double downscale) {
  constexpr int kTestEvery = 8;
  const Layout& layout = layout_of(folder);
  StatedDataset stated = layout.read(folder);
  std::stable_sort(stated.views.begin(), stated.views.end(),
                   [](const StatedView& a, const StatedView& b) { return a.name < b.name; });
  refuse_equal_names(stated.views);

  Dataset dataset;
  dataset.folder = folder;
  dataset.layout = layout.name;
  dataset.files = std::move(stated.files);
  dataset.split_by = stated.split_by;
  dataset.tests_from = std::move(stated.tests_from);
  dataset.left_out = stated.left_out;
  dataset.points = std::move(stated.points);
  dataset.bounds = stated.bounds;
  for (const StatedView& view : stated.views) {
    const int number = static_cast<int>(dataset.views.size());
    dataset.views.push_back(complete_view(view));
    DatasetView& added = dataset.views.back();
    added.camera.id = number;
    if (downscale != 1) added.camera = downscaled_camera(added, downscale);
    if (stated.split_by == SplitBy::kEveryEighth) {
      added.split = number % kTestEvery == 0 ? Split::kTest : Split::kTrain;
    }
  }
  if (views_of(dataset, Split::kTrain).empty()) {
    throw InputError(
        fmt::format("{}: holds {} views ({}), none to train from, expected one or more", folder,
                    dataset.views.size(), layout.name));
  }
  return dataset;
}

void require_test_views(const Dataset& dataset) {
  if (!views_of(dataset, Split::kTest).empty()) return;
  throw InputError(
      fmt::format("{}: got none, expected one view or more to test with", dataset.tests_from));
}

Camera downscaled_camera(const DatasetView& view, double downscale) {
  if (!(downscale >= 1 && std::isfinite(downscale))) {
    throw InputError(
        fmt::format("view '{}': downscale {}, expected a number from 1", view.name, downscale));
  }
  const auto smaller = [downscale](int px) {
    return std::max(1, static_cast<int>(std::lround(px / downscale)));
  };
  return scaled_to(view.camera, smaller(view.camera.width), smaller(view.camera.height));
}

RgbaImage load_view(const DatasetView& view, double downscale) {
  const Camera camera = downscaled_camera(view, downscale);
  RgbaImage image = read_photograph(view.image_path);
  if (image.width != view.file.width || image.height != view.file.height) {
    throw InputError(fmt::format("{}: got {}x{} px, expected {}x{} as when the data set was opened",
                                 view.image_path, image.width, image.height, view.file.width,
                                 view.file.height));
  }
  if (view.used_px.x != image.width || view.used_px.y != image.height) {
    image = cropped(image, view.crop_px.x, view.crop_px.y, view.used_px.x, view.used_px.y);
  }
  if (image.width == camera.width && image.height == camera.height) return image;
  return area_averaged(image, camera.width, camera.height);
}

}  // namespace sgs
