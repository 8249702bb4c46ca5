#include "algorithm/dataset/view_cameras.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "algorithm/dataset/image_search.h"
#include "algorithm/dataset/layout.h"
#include "algorithm/dataset/layouts.h"
#include "algorithm/dataset/nerfstudio_path.h"
#include "algorithm/dataset/view_image.h"
#include "algorithm/files/input_error.h"
#include "algorithm/files/input_json.h"

namespace sgs {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

bool states_size(const Intrinsics& intrinsics) {
  return intrinsics.width > 0 && intrinsics.height > 0;
}

// Its image's header is read where nothing else states the size.
Projection projection_in(const StatedView& view, const std::string& root) {
  if (states_size(view.intrinsics)) return projection_of(view.intrinsics, 0, 0);
  const ImageHeader image = ImageSearch(root, "").image(view).header;
  return projection_of(view.intrinsics, image.width, image.height);
}

void check_centre(const StatedView& view, const Projection& stated) {
  for (int axis = 0; axis < 2; ++axis) {
    const double at = stated.centre[axis];
    const int size = axis == 0 ? stated.width : stated.height;
    if (at >= 0 && at <= size) continue;
    throw InputError(
        fmt::format("{}: principal point: got {} at {} px of {}, expected it in the picture",
                    view.where, axis == 0 ? "x" : "y", at, size));
  }
}

Camera camera_of(const StatedView& view, const std::string& root) {
  const Projection stated = projection_in(view, root);
  check_camera(view, stated);
  check_centre(view, stated);
  Camera camera;
  camera.name = view_name(slashed(view.image));
  camera.width = stated.width;
  camera.height = stated.height;
  camera.focal_x = stated.focal.x;
  camera.focal_y = stated.focal.y;
  camera.principal_offset = stated.centre - 0.5 * glm::dvec2(stated.width, stated.height);
  camera.position = view.pose.position;
  camera.world_from_camera = view.pose.world_from_camera;
  return camera;
}

std::string note_of(const StatedDataset& stated) {
  std::set<std::string> models;
  int views = 0;
  for (const StatedView& view : stated.views) {
    if (is_pinhole(view.intrinsics.lens)) continue;
    ++views;
    models.insert(view.intrinsics.lens.model);
  }
  std::vector<std::string> parts;
  if (views > 0) {
    parts.push_back(
        fmt::format("{} cameras have a lens ({}) and are drawn as pinholes of its focal "
                    "lengths",
                    views, join(models)));
  }
  std::vector<std::string> keys;
  for (const auto& [key, count] : stated.unread_keys) keys.push_back(key);
  if (!keys.empty()) parts.push_back("not read: " + join(keys));
  return join(parts, "; ");
}

ViewCameras cameras_of_views(const StatedDataset& stated, const std::string& root) {
  ViewCameras out;
  for (const StatedView& view : stated.views) {
    out.cameras.push_back(camera_of(view, root));
    out.cameras.back().id = static_cast<int>(out.cameras.size()) - 1;
  }
  out.files = stated.files;
  out.note = note_of(stated);
  return out;
}

ViewCameras of_folder(const std::string& folder) {
  StatedDataset stated = layout_of(folder, "").read(folder);
  std::stable_sort(stated.views.begin(), stated.views.end(),
                   [](const StatedView& a, const StatedView& b) {
                     return view_name(slashed(a.image)) < view_name(slashed(b.image));
                   });
  return cameras_of_views(stated, folder);
}

bool is_of_colmap(const fs::path& path) {
  const std::string extension = path.extension().string(), name = path.stem().string();
  return (extension == ".bin" || extension == ".txt") && (name == "cameras" || name == "images");
}

}  // namespace

ViewCameras view_cameras_of(const Json& document, const std::string& path) {
  ViewCameras out;
  out.files = {path};
  if (document.is_object() && document.contains("frames")) {
    const fs::path folder = fs::path(path).parent_path();
    return cameras_of_views(frames_of_transforms(document, path),
                            folder.empty() ? "." : folder.string());
  }
  if (document.is_object() && document.contains("camera_path")) {
    out.cameras = nerfstudio_cameras_of(document, path);
    return out;
  }
  if (document.is_object()) {
    throw InputError(fmt::format(
        "{}: got an object without frames and camera_path, expected an array of cameras as "
        "cameras.json, a transforms.json or a camera path of nerfstudio",
        path));
  }
  out.cameras = cameras_of(document, path);
  return out;
}

ViewCameras read_view_cameras(const std::string& path) {
  std::error_code unknown;
  if (fs::is_directory(path, unknown)) return of_folder(path);
  if (is_of_colmap(path)) {
    const fs::path folder = fs::path(path).parent_path();
    return of_folder(folder.empty() ? "." : folder.string());
  }
  return view_cameras_of(read_json(path), path);
}

}  // namespace sgs
