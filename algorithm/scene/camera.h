// Pinhole cameras.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>
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
  // The principal point minus the middle of the picture, px; x right, y down.
  glm::dvec2 principal_offset{0.0};
  // Distance of a second eye to the right of this one, along the x axis and with the same axes,
  // world units; 0: there is none.
  double eyes_apart = 0;
  // How its file states poses, for messages; a text that stays. Empty: no file does.
  std::string_view axes;
};

// `a`, moved and turned towards `b`: on the line between their centres, on the shortest way between
// their axes. t: 0, as `a` stands, to 1, as `b` does. All else is `a`'s.
Camera camera_between(const Camera& a, const Camera& b, double t);

// Writes `cameras` as the original's cameras.json; read_view_cameras() gives them back bit for bit.
// Throws InputError when `path` cannot be created.
void write_cameras(const std::string& path, const std::vector<Camera>& cameras);

// The same view at `width` x `height` px: focal_x scales with the width, focal_y with the height,
// so that the field of view stays; the principal point moves along. Throws InputError when a size
// is not positive.
Camera scaled_to(const Camera& camera, int width, int height);

}  // namespace sgs
