// Scenes made by the program itself, for demonstrations and for tests that need no files.
#pragma once

#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "algorithm/scene/camera.h"
#include "algorithm/scene/gaussian_cloud.h"

namespace sgs {

struct BuiltinScene {
  GaussianCloud cloud;          // SH degree 3
  std::vector<Camera> cameras;  // at least four, 640x360 px but for capture's 980x545
};

// A way through a built-in scene.
struct BuiltinPath {
  std::string name;
  std::vector<Camera> keys;  // of the size of the scene's cameras
  bool closed = false;       // from the last key back to the first
};

// True if `spec` names a built-in scene, that is, begins with "builtin:".
bool is_builtin_scene(const std::string& spec);

// Makes the scene of `spec`, "builtin:NAME" or "builtin:NAME?n=COUNT" with COUNT Gaussians, 1 to
// 20,000,000:
//   capture  a rocket on a square, photographed from a ring and trained, in COLMAP's unit (default
//            1,000,000)
//   object   a toy rocket on a chequered table, a few units large (default 60,000)
//   outdoor  a landscape with trees, a house and a tower, a sky of far splats, needles and
//            floaters, outliers 20,000 units away (default 200,000)
// The y axis points down. The same spec gives the same bits on every machine with IEEE floats and
// the same mathematical library, whatever the number of threads. Throws InputError that says what
// is allowed when the name, a key or the count is not.
BuiltinScene make_builtin_scene(const std::string& spec);

// The way through the scene of `spec`: `ring` and `turntable`, round capture and object, or `walk`,
// over the meadow of outdoor to its pond and on to the house. Throws InputError as above.
BuiltinPath builtin_path(const std::string& spec);

// A 640x360 camera at `eye` that looks at `target` with level horizon (world y down) and a
// horizontal field of view of `fov_degrees`. The line of sight must not be vertical.
Camera look_at(int id, const std::string& name, const glm::dvec3& eye, const glm::dvec3& target,
               double fov_degrees);

}  // namespace sgs
