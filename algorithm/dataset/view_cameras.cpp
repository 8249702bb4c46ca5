#include "algorithm/dataset/view_cameras.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "algorithm/dataset/image_search.h"
#include "algorithm/dataset/layout.h"
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
    const Projection projection = projection_in(view, root);
    check_camera(view, projection);
    Camera camera = camera_of(view, projection);
    camera.id = view.id.value_or(static_cast<int>(out.cameras.size()));
    camera.name = view.id ? view.image : view_name(slashed(view.image));
    out.cameras.push_back(std::move(camera));
  }
  out.files = stated.files;
  out.path = stated.path;
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

StatedDataset views_of(const Json& document, const std::string& path) {
  if (!document.is_object() || document.contains("cameras")) {
    return views_of_cameras_json(document, path);
  }
  if (document.contains("frames")) return views_of_transforms(document, path);
  if (document.contains("camera_path")) return views_of_camera_path(document, path);
  throw InputError(fmt::format(
      "{}: got an object without cameras, frames and camera_path, expected an array of cameras as "
      "cameras.json, a transforms.json or a camera path of nerfstudio",
      path));
}

bool is_of_colmap(const fs::path& path) {
  const std::string extension = path.extension().string(), name = path.stem().string();
  return (extension == ".bin" || extension == ".txt") && (name == "cameras" || name == "images");
}

}  // namespace

ViewCameras read_view_cameras(const std::string& path) {
  std::error_code unknown;
  if (fs::is_directory(path, unknown)) return of_folder(path);
  const fs::path above = fs::path(path).parent_path();
  const std::string folder = above.empty() ? "." : above.string();
  if (is_of_colmap(path)) return of_folder(folder);
  return cameras_of_views(views_of(read_json(path), path), folder);
}

}  // namespace sgs
