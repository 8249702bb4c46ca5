// What all layouts have in common, and the reading of a view's image.
#include "algorithm/dataset/dataset.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "algorithm/dataset/dataset_notes.h"
#include "algorithm/dataset/image_search.h"
#include "algorithm/dataset/layout.h"
#include "algorithm/dataset/view_image.h"
#include "algorithm/files/input_error.h"
#include "algorithm/image/image_io.h"
#include "algorithm/scene/camera.h"

namespace sgs {
namespace {

// A view and its image.
struct FoundView {
  StatedView stated;
  FoundImage image;
  std::string name;
};

void refuse_equal_names(const std::vector<FoundView>& by_name) {
  const auto twice =
      std::adjacent_find(by_name.begin(), by_name.end(),
                         [](const FoundView& a, const FoundView& b) { return a.name == b.name; });
  if (twice != by_name.end()) {
    throw InputError(fmt::format("{}: name '{}' a second time, after {}, expected each once",
                                 (twice + 1)->stated.where, twice->name, twice->stated.where));
  }
}

// Of those views whose images are to have one shape.
void check_one_shape(const std::vector<FoundView>& views) {
  const FoundImage* first = nullptr;
  for (const FoundView& view : views) {
    if (!view.stated.shares_shape) continue;
    if (first == nullptr) first = &view.image;
    const ImageHeader &one = view.image.header, &other = first->header;
    if (of_one_shape(one.width, one.height, other.width, other.height)) continue;
    throw InputError(fmt::format("{}: {} is {}x{} px, expected the shape of {}, {}x{} px",
                                 view.stated.where, view.image.path, one.width, one.height,
                                 first->path, other.width, other.height));
  }
}

// By name.
std::vector<FoundView> found_views(std::vector<StatedView> stated, const ImageSearch& search) {
  std::vector<FoundView> views;
  for (StatedView& view : stated) {
    FoundImage image = search.image(view);
    std::string name = view_name(image.name);
    views.push_back({std::move(view), std::move(image), std::move(name)});
  }
  check_one_shape(views);
  std::stable_sort(views.begin(), views.end(),
                   [](const FoundView& a, const FoundView& b) { return a.name < b.name; });
  refuse_equal_names(views);
  return views;
}

}  // namespace

std::vector<int> views_of(const Dataset& dataset, Split split) {
  std::vector<int> numbers;
  for (const DatasetView& view : dataset.views) {
    if (view.split == split) numbers.push_back(view.camera.id);
  }
  return numbers;
}

Dataset open_dataset(const std::string& folder, const DatasetOptions& options) {
  constexpr int kTestEvery = 8;
  const Layout& layout = layout_of(folder, options.layout);
  StatedDataset stated = layout.read(folder);
  const ImageSearch search(folder, options.images);
  const std::vector<FoundView> views = found_views(std::move(stated.views), search);

  Dataset dataset;
  dataset.folder = folder;
  dataset.layout = layout.name;
  dataset.files = std::move(stated.files);
  dataset.split_by = stated.split_by;
  dataset.tests_from = std::move(stated.tests_from);
  dataset.left_out = stated.left_out;
  if (stated.read_points) dataset.points = stated.read_points();
  dataset.bounds = stated.bounds;
  for (const FoundView& view : views) {
    const int number = static_cast<int>(dataset.views.size());
    dataset.views.push_back(complete_view(view.stated, view.image));
    DatasetView& added = dataset.views.back();
    if (!view.stated.mask.empty()) added.mask_path = search.mask(view.stated).path;
    added.camera.id = number;
    if (options.downscale != 1) added.camera = downscaled_camera(added, options.downscale);
    if (stated.split_by == SplitBy::kEveryEighth) {
      added.split = number % kTestEvery == 0 ? Split::kTest : Split::kTrain;
    }
  }
  if (views_of(dataset, Split::kTrain).empty()) {
    throw InputError(
        fmt::format("{}: holds {} views ({}), none to train from, expected one or more", folder,
                    dataset.views.size(), layout.name));
  }
  dataset.notes = notes_of(dataset, stated.unread_keys, search.instead());
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

namespace {

RgbaImage checked(const DatasetView& view, RgbaImage image) {
  if (image.width == view.file.width && image.height == view.file.height) return image;
  throw InputError(fmt::format("{}: got {}x{} px, expected {}x{} as when the data set was opened",
                               view.image_path, image.width, image.height, view.file.width,
                               view.file.height));
}

// image: of the file's size. Made a pinhole's or cut, then averaged.
RgbaImage as_seen(const DatasetView& view, RgbaImage image, const Camera& camera) {
  if (!is_pinhole(view.taken.lens)) {
    image = undistorted(image, view.taken, view.used_px);
  } else if (view.used_px.x != image.width || view.used_px.y != image.height) {
    image = cropped(image, view.crop_px.x, view.crop_px.y, view.used_px.x, view.used_px.y);
  }
  if (image.width == camera.width && image.height == camera.height) return image;
  return area_averaged(image, camera.width, camera.height);
}

// Alpha 1 where the mask is not black. Of the file's size, whatever size the mask has.
RgbaImage mask_of(const DatasetView& view) {
  const RgbaImage mask = read_photograph(view.mask_path);
  const int width = view.file.width, height = view.file.height;
  if (!of_one_shape(mask.width, mask.height, width, height)) {
    throw InputError(fmt::format("{}: got a mask of {}x{} px, expected the shape of {}, {}x{} px",
                                 view.mask_path, mask.width, mask.height, view.image_path, width,
                                 height));
  }
  RgbaImage counts(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const auto at = [](int px, int size, int of) {
        return static_cast<int>((static_cast<std::int64_t>(px) * of + of / 2) / size);
      };
      const glm::vec4& pixel = mask.at(at(x, width, mask.width), at(y, height, mask.height));
      if (pixel.x > 0 || pixel.y > 0 || pixel.z > 0) counts.at(x, y).w = 1;
    }
  }
  return counts;
}

}  // namespace

RgbaImage load_view(const DatasetView& view, double downscale) {
  const Camera camera = downscaled_camera(view, downscale);
  return as_seen(view, checked(view, read_photograph(view.image_path)), camera);
}

std::vector<std::uint8_t> load_mask(const DatasetView& view, double downscale) {
  constexpr float kWhole = 0.999F;  // but for rounding, no black has a part in it
  if (view.mask_path.empty()) return {};
  const RgbaImage seen = as_seen(view, mask_of(view), downscaled_camera(view, downscale));
  std::vector<std::uint8_t> counts;
  counts.reserve(seen.pixels.size());
  for (const glm::vec4& pixel : seen.pixels) counts.push_back(pixel.w >= kWhole ? 1 : 0);
  if (std::find(counts.begin(), counts.end(), 1) == counts.end()) {
    throw InputError(
        fmt::format("{}: got a mask that leaves no pixel, expected one or more that "
                    "are not black",
                    view.mask_path));
  }
  return counts;
}

}  // namespace sgs
