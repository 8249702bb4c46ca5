#include "algorithm/dataset/dataset_notes.h"

#include <fmt/format.h>

#include <set>

#include "algorithm/files/input_error.h"

namespace sgs {
namespace {

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

}  // namespace

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

}  // namespace sgs
