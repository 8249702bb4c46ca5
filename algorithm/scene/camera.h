// Pinhole cameras, and their form in the original's cameras.json.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace sgs {

// A pinhole camera in the form of the original's cameras.json.
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
};

// `a`, moved and turned towards `b`: on the line between their centres, on the shortest way between
// their axes. t: 0, as `a` stands, to 1, as `b` does. All else is `a`'s.
Camera camera_between(const Camera& a, const Camera& b, double t);

// Reads a JSON array of {id, img_name, width, height, position, rotation, fx, fy}; other keys are
// ignored, but for cx and cy. `position` is the centre in the world; the columns of `rotation` (an
// array of rows) are the camera's x right, y down, z forward axes in the world; cx and cy are the
// principal point, px from the top left corner, in the middle where they are not given. Throws
// InputError that names file, entry and key: a key missing or of the wrong type, a size or focal
// length that is not positive, a number that is not finite or beyond gaussian_cloud.h, a rotation
// whose columns are not orthonormal within 1e-3 or which mirrors, a principal point outside the
// picture.
std::vector<Camera> read_cameras(const std::string& path);

// The same of an array that was read already. origin: the file, and what of it, for messages.
std::vector<Camera> cameras_of(const nlohmann::ordered_json& array, const std::string& origin);

// Writes `cameras` in the same form; read_cameras gives them back bit for bit. Throws InputError
// when `path` cannot be created.
void write_cameras(const std::string& path, const std::vector<Camera>& cameras);

// The same view at `width` x `height` px: focal_x scales with the width, focal_y with the height,
// so that the field of view stays; the principal point moves along. Throws InputError when a size
// is not positive.
Camera scaled_to(const Camera& camera, int width, int height);

}  // namespace sgs
