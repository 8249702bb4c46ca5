// What text and binary models share, and COLMAP's layout (layouts.h).
#include "algorithm/dataset/colmap_model.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>

#include "algorithm/dataset/colmap_lens.h"
#include "algorithm/dataset/layouts.h"
#include "algorithm/files/input_error.h"

namespace sgs {

void add_colmap_camera(ColmapModel& model, std::uint32_t id, ColmapCamera camera) {
  const std::string where = camera.where;
  if (!model.cameras.emplace(id, std::move(camera)).second) {
    throw InputError(fmt::format("{}: camera id {} a second time, expected each once", where, id));
  }
}

namespace {

namespace fs = std::filesystem;

struct Place {
  fs::path folder;  // empty: there is none
  bool binary = false;
};

constexpr std::array<const char*, 2> kUsual = {"sparse/0", "sparse"};
constexpr std::array<const char*, 4> kAside = {"colmap/sparse/0", "colmap/sparse", "0", "."};

template <std::size_t kCount>
Place place_in(const fs::path& folder, const std::array<const char*, kCount>& places) {
  std::error_code unknown;
  for (const char* below : places) {
    for (const bool binary : {true, false}) {
      const fs::path model = (folder / below).lexically_normal();
      const char* extension = binary ? ".bin" : ".txt";
      if (fs::exists(model / (std::string("cameras") + extension), unknown)) return {model, binary};
    }
  }
  return {};
}

std::vector<SfmPoint> points_of(const Place& place) {
  std::error_code unknown;
  const std::string folder = place.folder.string();
  const bool own =
      fs::exists(place.folder / (place.binary ? "points3D.bin" : "points3D.txt"), unknown);
  if (const auto points = points_file_in(folder); points && !own) return read_points_ply(*points);
  return place.binary ? read_colmap_points_binary(folder) : read_colmap_points_text(folder);
}

}  // namespace

bool holds_colmap(const std::string& folder) { return !place_in(folder, kUsual).folder.empty(); }

bool holds_colmap_aside(const std::string& folder) {
  return !place_in(folder, kAside).folder.empty();
}

StatedDataset read_colmap(const std::string& folder) {
  Place place = place_in(folder, kUsual);
  if (place.folder.empty()) place = place_in(folder, kAside);
  const ColmapModel model = place.binary ? read_colmap_binary(place.folder.string())
                                         : read_colmap_text(place.folder.string());
  StatedDataset dataset;
  for (const char* name : {"cameras", "images", "points3D"}) {
    dataset.files.push_back(
        (place.folder / (name + std::string(place.binary ? ".bin" : ".txt"))).string());
  }
  dataset.read_points = [place] { return points_of(place); };
  // COLMAP looks for no features there; whether training is to leave it out nobody says.
  std::error_code unknown;
  if (fs::is_directory(fs::path(folder) / "masks", unknown)) {
    dataset.unread_keys["the folder masks"] = 1;
  }
  for (const ColmapImage& image : model.images) {
    const auto camera = model.cameras.find(image.camera_id);
    if (camera == model.cameras.end()) {
      throw InputError(fmt::format("{}: camera id {}: no such camera, expected one of {} cameras",
                                   image.where, image.camera_id, model.cameras.size()));
    }
    StatedView view;
    view.where = image.where;
    view.folders = {"images"};
    view.image = image.name;
    view.intrinsics = colmap_intrinsics(camera->second);
    view.pose = image.pose;
    dataset.views.push_back(std::move(view));
  }
  return dataset;
}

}  // namespace sgs
