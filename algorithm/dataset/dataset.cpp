// What all layouts have in common.
#include "algorithm/dataset/dataset.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "algorithm/dataset/image_search.h"
#include "algorithm/dataset/layout.h"
#include "algorithm/dataset/view_image.h"
#include "algorithm/files/input_error.h"
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

// Empty where no view has a lens with distortion.
std::string of_lenses(const Dataset& dataset) {
  std::set<std::string> models;
  int views = 0;
  double file_px = 0, seen_px = 0;
  bool fisheye = false;
  for (const DatasetView& view : dataset.views) {
    const Lens& lens = view.taken.lens;
    if (is_pinhole(lens)) continue;
    ++views;
    models.insert(lens.model);
    fisheye = fisheye || lens.kind == LensKind::kFisheye;
    const double px = static_cast<double>(view.file.width) * view.file.height;
    file_px += px;
    seen_px += view.seen * px;
  }
  if (views == 0) return {};
  return fmt::format(
      "{} views ({}), {:.1f} % of their pixels are lost{}", views, join(models),
      100 * (1 - seen_px / file_px),
      fisheye ? fmt::format("; at most {} degrees are seen", kWidestFieldDegrees) : "");
}

std::string of_masks(const Dataset& dataset) {
  int views = 0;
  for (const DatasetView& view : dataset.views) views += view.mask_path.empty() ? 0 : 1;
  if (views == 0) return {};
  return fmt::format("of {} views: what is black in them is in no loss and no quality", views);
}

std::string of_keys(const std::map<std::string, int>& unread_keys) {
  std::vector<std::string> words;
  for (const auto& [key, count] : unread_keys) {
    words.push_back(count == 1 ? key : fmt::format("{} ({} times)", key, count));
  }
  return join(words);
}

// A title and a sentence each: photographs made a pinhole's, with the share of pixels that is lost;
// masks; another folder of images (empty: none); names that were not read.
std::vector<std::pair<std::string, std::string>> notes_of(
    const Dataset& dataset, const std::map<std::string, int>& unread_keys,
    const std::string& instead_of_images) {
  std::vector<std::pair<std::string, std::string>> notes;
  const auto note = [&](const char* title, std::string text) {
    if (!text.empty()) notes.emplace_back(title, std::move(text));
  };
  note("undistorted", of_lenses(dataset));
  note("masks", of_masks(dataset));
  note("images from", instead_of_images);
  note("not read", of_keys(unread_keys));
  return notes;
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

}  // namespace sgs
