// The written form of cameras, resizing, and the way between two of them.
#include "algorithm/scene/camera.h"

#include <fmt/format.h>

#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <nlohmann/json.hpp>

#include "algorithm/files/input_error.h"
#include "algorithm/files/output_file.h"

namespace sgs {

Camera camera_between(const Camera& a, const Camera& b, double t) {
  Camera camera = a;
  // Ends are the poses as given: a quaternion and back rounds.
  if (t == 0) return camera;
  if (t == 1) {
    camera.position = b.position;
    camera.world_from_camera = b.world_from_camera;
    return camera;
  }
  camera.position = (1 - t) * a.position + t * b.position;
  camera.world_from_camera = glm::mat3_cast(
      glm::slerp(glm::quat_cast(a.world_from_camera), glm::quat_cast(b.world_from_camera), t));
  return camera;
}

void write_cameras(const std::string& path, const std::vector<Camera>& cameras) {
  using Json = nlohmann::ordered_json;
  Json json = Json::array();
  for (const Camera& camera : cameras) {
    const glm::dmat3 rows = glm::transpose(camera.world_from_camera);
    Json rotation = Json::array();
    for (int row = 0; row < 3; ++row) rotation.push_back({rows[row].x, rows[row].y, rows[row].z});
    json.push_back({{"id", camera.id},
                    {"img_name", camera.name},
                    {"width", camera.width},
                    {"height", camera.height},
                    {"position", {camera.position.x, camera.position.y, camera.position.z}},
                    {"rotation", rotation},
                    {"fy", camera.focal_y},
                    {"fx", camera.focal_x}});
    if (camera.principal_offset == glm::dvec2(0)) continue;
    json.back()["cx"] = 0.5 * camera.width + camera.principal_offset.x;
    json.back()["cy"] = 0.5 * camera.height + camera.principal_offset.y;
  }
  const std::string text = json.dump(1) + "\n";
  write_whole_file(path, text.data(), text.size());
}

Camera scaled_to(const Camera& camera, int width, int height) {
  if (width < 1 || height < 1 || camera.width < 1 || camera.height < 1) {
    throw InputError(fmt::format("camera {} of {}x{} scaled to {}x{}: expected sizes from 1 px",
                                 camera.id, camera.width, camera.height, width, height));
  }
  Camera scaled = camera;
  scaled.width = width;
  scaled.height = height;
  scaled.focal_x = camera.focal_x * width / camera.width;
  scaled.focal_y = camera.focal_y * height / camera.height;
  scaled.principal_offset = {camera.principal_offset.x * width / camera.width,
                             camera.principal_offset.y * height / camera.height};
  return scaled;
}

}  // namespace sgs
