// cameras.json of the original (layouts.h).
#include <fmt/format.h>

#include <filesystem>

#include "algorithm/dataset/layouts.h"
#include "algorithm/scene/camera.h"

namespace sgs {
namespace {

namespace fs = std::filesystem;

fs::path file_in(const std::string& folder) { return fs::path(folder) / "cameras.json"; }

}  // namespace

bool holds_cameras_json(const std::string& folder) {
  std::error_code unknown;
  return fs::exists(file_in(folder), unknown);
}

StatedDataset read_cameras_json(const std::string& folder) {
  const std::string path = file_in(folder).string();
  StatedDataset dataset;
  dataset.files = {path};
  for (const Camera& camera : read_cameras(path)) {
    StatedView view;
    view.where = fmt::format("{}: camera {}", path, dataset.views.size());
    view.folders = {"images", ""};
    view.image = camera.name;
    view.intrinsics.width = camera.width;
    view.intrinsics.height = camera.height;
    view.intrinsics.focal_x = camera.focal_x;
    view.intrinsics.focal_y = camera.focal_y;
    view.intrinsics.centre_x = 0.5 * camera.width + camera.principal_offset.x;
    view.intrinsics.centre_y = 0.5 * camera.height + camera.principal_offset.y;
    view.pose = {camera.position, camera.world_from_camera};
    dataset.views.push_back(std::move(view));
  }
  return dataset;
}

}  // namespace sgs
