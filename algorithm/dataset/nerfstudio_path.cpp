#include "algorithm/dataset/nerfstudio_path.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "algorithm/dataset/stated_view.h"
#include "algorithm/dataset/transforms_frame.h"
#include "algorithm/dataset/view_image.h"
#include "algorithm/files/input_error.h"
#include "algorithm/files/input_json.h"

namespace sgs {
namespace {

using Json = nlohmann::ordered_json;

int render_size(const TransformsFrame& file, const char* key) {
  const double size = file.number(key).value_or(0);
  if (!(size >= 1 && size <= INT32_MAX) || size != std::floor(size)) {
    file.fail(key, fmt::format("{}", size), "a whole number of px from 1");
  }
  return static_cast<int>(size);
}

void check_kind(const TransformsFrame& file, const Json& document) {
  const std::string type = file.text("camera_type").value_or("perspective");
  if (type != "perspective") file.fail("camera_type", type, "perspective");
  const auto crop = document.find("crop");
  if (crop != document.end() && !crop->is_null()) {
    file.fail("crop", shown(*crop), "null: the whole scene is drawn");
  }
}

glm::dmat4 path_pose(const TransformsFrame& frame) {
  const std::vector<double> numbers = frame.numbers("camera_to_world");
  if (numbers.size() != 16) {
    frame.fail("camera_to_world", fmt::format("{} numbers", numbers.size()), "16, row by row");
  }
  glm::dmat4 out(1.0);
  for (int i = 0; i < 16; ++i) out[i % 4][i / 4] = numbers[static_cast<std::size_t>(i)];
  return out;
}

double focal_px(const TransformsFrame& frame, int height) {
  const double degrees = frame.number("fov").value_or(0);
  if (!(degrees > 0 && degrees < 180)) {
    frame.fail("fov", fmt::format("{}", degrees), "degrees between 0 and 180");
  }
  return 0.5 * height / std::tan(0.5 * degrees * M_PI / 180);
}

}  // namespace

std::vector<Camera> nerfstudio_cameras_of(const Json& document, const std::string& origin) {
  const Json none = Json::object();
  const TransformsFrame file(document, none, origin);
  check_kind(file, document);
  StatedView view;
  view.intrinsics.width = render_size(file, "render_width");
  view.intrinsics.height = render_size(file, "render_height");
  const Json& path = document["camera_path"];
  if (!path.is_array()) file.fail("camera_path", shown(path), "an array of cameras");
  std::vector<Camera> cameras;
  for (const Json& entry : path) {
    view.where = fmt::format("{}: camera_path[{}]", origin, cameras.size());
    const TransformsFrame frame(none, entry, view.where);
    view.intrinsics.focal_x = focal_px(frame, view.intrinsics.height);
    view.pose = opengl_pose(path_pose(frame), view.where);
    const Projection stated = projection_of(view.intrinsics, 0, 0);
    check_camera(view, stated);
    Camera camera;
    camera.id = static_cast<int>(cameras.size());
    camera.name = fmt::format("frame_{:05}", camera.id);
    camera.width = stated.width;
    camera.height = stated.height;
    camera.focal_x = stated.focal.x;
    camera.focal_y = stated.focal.y;
    camera.position = view.pose.position;
    camera.world_from_camera = view.pose.world_from_camera;
    cameras.push_back(camera);
  }
  return cameras;
}

}  // namespace sgs
