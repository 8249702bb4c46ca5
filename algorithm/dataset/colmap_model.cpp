// The checks that text and binary models share, and COLMAP's layout (layouts.h).
#include "algorithm/dataset/colmap_model.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "algorithm/dataset/layouts.h"
#include "algorithm/dataset/view_image.h"
#include "algorithm/files/input_error.h"

namespace sgs {

int colmap_parameter_count(std::string_view model, const std::string& where) {
  if (model == "SIMPLE_PINHOLE") return 3;  // f, c_x, c_y
  if (model == "PINHOLE") return 4;         // f_x, f_y, c_x, c_y
  throw InputError(fmt::format(
      "{}: got the camera model {}, expected PINHOLE or SIMPLE_PINHOLE (COLMAP's image_undistorter "
      "makes them)",
      where, model));
}

Intrinsics colmap_intrinsics(std::uint64_t width, std::uint64_t height,
                             const std::vector<double>& parameters, const std::string& where) {
  if (width < 1 || height < 1 || width > INT32_MAX || height > INT32_MAX) {
    throw InputError(fmt::format("{}: size: got {}x{}, expected px from 1", where, width, height));
  }
  for (const double parameter : parameters) {
    if (!std::isfinite(parameter)) {
      throw InputError(
          fmt::format("{}: parameter: got {}, expected finite numbers", where, parameter));
    }
  }
  const bool one_focal = parameters.size() == 3;
  const std::size_t centre = one_focal ? 1 : 2;
  return {static_cast<int>(width), static_cast<int>(height), parameters[0],
          parameters[one_focal ? 0 : 1], glm::dvec2(parameters[centre], parameters[centre + 1])};
}

void add_colmap_camera(ColmapModel& model, std::uint32_t id, const Intrinsics& camera,
                       const std::string& where) {
  if (!model.cameras.emplace(id, camera).second) {
    throw InputError(fmt::format("{}: camera id {} a second time, expected each once", where, id));
  }
}

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
