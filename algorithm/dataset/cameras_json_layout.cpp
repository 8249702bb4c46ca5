// cameras.json of the original (layouts.h).
#include <fmt/format.h>

#include <filesystem>

#include "algorithm/dataset/layouts.h"
#include "algorithm/dataset/view_image.h"
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
  const std::vector<std::string> places = {(fs::path(folder) / "images").string(), folder};
  StatedDataset dataset;
  dataset.files = {path};
  for (const Camera& camera : read_cameras(path)) {
    const std::string where = fmt::format("{}: camera {}", path, dataset.views.size());
    const FoundImage found = find_image(places, camera.name, where);
    const Intrinsics intrinsics = {camera.width, camera.height, camera.focal_x, camera.focal_y, {}};
    dataset.views.push_back({where,
                             view_name(camera.name),
                             found.path,
                             found.header,
                             intrinsics,
                             {camera.position, camera.world_from_camera},
                             Split::kTrain});
  }
  return dataset;
}

}  // namespace sgs
