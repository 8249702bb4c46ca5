// A pinhole camera in the form of the original's cameras.json (principal point in the middle).
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace sgs {

struct Camera {
  int id = 0;
  std::string name;
  int width = 0, height = 0;        // px
  double focal_x = 0, focal_y = 0;  // px
  glm::dvec3 position{0.0};         // centre, world frame
  // Columns are the camera's x right, y down, z forward axes in the world frame:
  // world_from_camera[0] is the x axis. The view transform is v = R^T (p - position).
  glm::dmat3 world_from_camera{1.0};
};

}  // namespace sgs
