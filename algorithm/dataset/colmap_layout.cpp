// COLMAP's model and its images (layouts.h).
#include <fmt/format.h>

#include <filesystem>

#include "algorithm/dataset/colmap_model.h"
#include "algorithm/dataset/find_image.h"
#include "algorithm/dataset/layouts.h"
#include "algorithm/input_error.h"

namespace sgs {
namespace {

namespace fs = std::filesystem;

struct Place {
  fs::path folder;  // empty: there is none
  bool binary = false;
};

Place place_of_model(const fs::path& folder) {
  std::error_code unknown;
  for (const char* below : {"sparse/0", "sparse"}) {
    for (const bool binary : {true, false}) {
      const fs::path cameras = folder / below / (binary ? "cameras.bin" : "cameras.txt");
      if (fs::exists(cameras, unknown)) return {folder / below, binary};
    }
  }
  return {};
}

}  // namespace

bool holds_colmap(const std::string& folder) { return !place_of_model(folder).folder.empty(); }

StatedDataset read_colmap(const std::string& folder) {
  const Place place = place_of_model(folder);
  ColmapModel model = place.binary ? read_colmap_binary(place.folder.string())
                                   : read_colmap_text(place.folder.string());
  StatedDataset dataset;
  for (const char* name : {"cameras", "images", "points3D"}) {
    dataset.files.push_back(
        (place.folder / (name + std::string(place.binary ? ".bin" : ".txt"))).string());
  }
  dataset.points = std::move(model.points);
  const std::string images = (fs::path(folder) / "images").string();
  for (const ColmapImage& image : model.images) {
    const auto camera = model.cameras.find(image.camera_id);
    if (camera == model.cameras.end()) {
      throw InputError(fmt::format("{}: camera id {}: no such camera, expected one of {} cameras",
                                   image.where, image.camera_id, model.cameras.size()));
    }
    const FoundImage found = find_image({images}, image.name, image.where);
    dataset.views.push_back({image.where, view_name(image.name), found.path, found.header,
                             camera->second, image.pose, Split::kTrain});
  }
  return dataset;
}

}  // namespace sgs
