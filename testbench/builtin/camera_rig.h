// Cameras for built-in scenes.
#pragma once

#include <glm/vec3.hpp>
#include <string>

#include "algorithm/scene/camera.h"

namespace sgs {

// A 640x360 camera at `eye` that looks at `target` with level horizon (world y down) and a
// horizontal field of view of `fov_degrees`. The line of sight must not be vertical.
Camera look_at(int id, const std::string& name, const glm::dvec3& eye, const glm::dvec3& target,
               double fov_degrees);

}  // namespace sgs
