// What text and binary models share, lenses, and COLMAP's layout (layout.h).
#include "algorithm/dataset/colmap_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "algorithm/dataset/layout.h"
#include "algorithm/files/input_error.h"

namespace sgs {
namespace {

// f_x, f_y or f for both; c_x, c_y; then a letter each: 1 to 6 for k1 to k6, p and q for p1 and p2,
// - for one that is not read.
struct ColmapLens {
  const char* model;
  int focals;
  const char* rest;
  LensKind kind;
};

// By their number in the file. EQUIRECTANGULAR has two numbers in all.
constexpr std::array<ColmapLens, 18> kLenses = {
    {{"SIMPLE_PINHOLE", 1, "", LensKind::kPerspective},
     {"PINHOLE", 2, "", LensKind::kPerspective},
     {"SIMPLE_RADIAL", 1, "1", LensKind::kPerspective},
     {"RADIAL", 1, "12", LensKind::kPerspective},
     {"OPENCV", 2, "12pq", LensKind::kPerspective},
     {"OPENCV_FISHEYE", 2, "1234", LensKind::kFisheye},
     {"FULL_OPENCV", 2, "12pq3456", LensKind::kPerspective},
     {"FOV", 2, "1", LensKind::kFov},
     {"SIMPLE_RADIAL_FISHEYE", 1, "1", LensKind::kFisheye},
     {"RADIAL_FISHEYE", 1, "12", LensKind::kFisheye},
     {"THIN_PRISM_FISHEYE", 2, "--------", LensKind::kOther},
     {"RAD_TAN_THIN_PRISM_FISHEYE", 2, "------------", LensKind::kOther},
     {"SIMPLE_DIVISION", 1, "1", LensKind::kDivision},
     {"DIVISION", 2, "1", LensKind::kDivision},
     {"SIMPLE_FISHEYE", 1, "", LensKind::kFisheye},
     {"FISHEYE", 2, "", LensKind::kFisheye},
     {"EUCM", 2, "--", LensKind::kOther},
     {"EQUIRECTANGULAR", 0, "", LensKind::kOther}}};

int count_of(const ColmapLens& lens) {
  return lens.focals + 2 + static_cast<int>(std::string_view(lens.rest).size());
}

const ColmapLens* lens_of(std::string_view model) {
  const auto found = std::find_if(kLenses.begin(), kLenses.end(),
                                  [&](const ColmapLens& lens) { return lens.model == model; });
  return found == kLenses.end() ? nullptr : &*found;
}

}  // namespace

std::string colmap_model_name(std::int32_t number, const std::string& where) {
  if (number >= 0 && number < static_cast<std::int32_t>(kLenses.size())) {
    return kLenses[static_cast<std::size_t>(number)].model;
  }
  throw InputError(fmt::format("{}: got the camera model number {}, expected 0 to {}", where,
                               number, kLenses.size() - 1));
}

std::optional<int> colmap_parameter_count(std::string_view model) {
  const ColmapLens* lens = lens_of(model);
  if (lens == nullptr) return {};
  return count_of(*lens);
}

Intrinsics colmap_intrinsics(const ColmapCamera& camera) {
  if (camera.width < 1 || camera.height < 1 || camera.width > INT32_MAX ||
      camera.height > INT32_MAX) {
    throw InputError(fmt::format("{}: size: got {}x{}, expected px from 1", camera.where,
                                 camera.width, camera.height));
  }
  for (const double parameter : camera.parameters) {
    if (!std::isfinite(parameter)) {
      throw InputError(
          fmt::format("{}: parameter: got {}, expected finite numbers", camera.where, parameter));
    }
  }
  Intrinsics out;
  out.width = static_cast<int>(camera.width);
  out.height = static_cast<int>(camera.height);
  out.lens.model = camera.model;
  const ColmapLens* lens = lens_of(camera.model);
  out.lens.kind = lens == nullptr ? LensKind::kOther : lens->kind;
  if (out.lens.kind == LensKind::kOther) return out;
  auto next = camera.parameters.begin();
  out.focal_x = *next;
  if (lens->focals == 2) ++next;
  out.focal_y = *next++;
  out.centre_x = *next++;
  out.centre_y = *next++;
  for (const char* letter = lens->rest; *letter != '\0'; ++letter) {
    double& coefficient = *letter == 'p'   ? out.lens.p1
                          : *letter == 'q' ? out.lens.p2
                                           : out.lens.k[static_cast<std::size_t>(*letter - '1')];
    coefficient = *next++;
  }
  return out;
}

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

bool holds_model(const fs::path& folder) {
  std::error_code unknown;
  return fs::exists(folder / "cameras.bin", unknown) || fs::exists(folder / "cameras.txt", unknown);
}

// The mapper numbers its models: one for each part of the images that it could not join to others.
std::vector<std::string> models_beside(const fs::path& model, const std::string& folder) {
  const fs::path data_set = fs::path(folder).lexically_normal();
  if (model == data_set || model.filename() != "0") return {};
  std::vector<std::string> names;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(model.parent_path(), failed)) {
    const std::string name = entry.path().filename().string();
    const bool numbered = name.find_first_not_of("0123456789") == std::string::npos;
    if (!numbered || name == "0" || !holds_model(entry.path())) continue;
    names.push_back("the model " + entry.path().lexically_relative(data_set).string());
  }
  return names;
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
  for (const std::string& name : models_beside(place.folder, folder)) dataset.unread_keys[name] = 1;
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
