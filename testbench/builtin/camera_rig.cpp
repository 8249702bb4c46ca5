// The frame of camera_rig.h.
#include "testbench/builtin/camera_rig.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace sgs {

Camera look_at(int id, const std::string& name, const glm::dvec3& eye, const glm::dvec3& target,
               double fov_degrees) {
  constexpr glm::dvec3 kDown(0.0, 1.0, 0.0);
  Camera camera;
  camera.id = id;
  camera.name = name;
  camera.width = 640;
  camera.height = 360;
  camera.focal_x = 0.5 * camera.width / std::tan(0.5 * fov_degrees * M_PI / 180.0);
  camera.focal_y = camera.focal_x;
  camera.position = eye;
  const glm::dvec3 forward = glm::normalize(target - eye);
  const glm::dvec3 right = glm::normalize(glm::cross(kDown, forward));
  camera.world_from_camera = glm::dmat3(right, glm::cross(forward, right), forward);
  return camera;
}

}  // namespace sgs
