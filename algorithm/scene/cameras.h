// Reading, writing and resizing cameras in the form of the original's cameras.json.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "algorithm/scene/camera.h"

namespace sgs {

// Reads a JSON array of {id, img_name, width, height, position, rotation, fx, fy}; other keys are
// ignored. `position` is the centre in the world; the columns of `rotation` (an array of rows) are
// the camera's x right, y down, z forward axes in the world. Throws InputError that names file,
// entry and key: a key missing or of the wrong type, a size or focal length that is not positive, a
// number that is not finite or beyond gaussian_limits.h, a rotation whose columns are not
// orthonormal within 1e-3 or which mirrors.
std::vector<Camera> read_cameras(const std::string& path);

// The same of an array that was read already. origin: the file, and what of it, for messages.
std::vector<Camera> cameras_of(const nlohmann::ordered_json& array, const std::string& origin);

// Writes `cameras` in the same form; read_cameras gives them back bit for bit. Throws InputError
// when `path` cannot be created.
void write_cameras(const std::string& path, const std::vector<Camera>& cameras);

// The same view at `width` x `height` px: focal_x scales with the width, focal_y with the height,
// so that the field of view stays. Throws InputError when a size is not positive.
Camera scaled_to(const Camera& camera, int width, int height);

}  // namespace sgs
