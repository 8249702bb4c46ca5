// The camera paths that nerfstudio's viewer writes (nerfstudio/cameras/camera_paths.py).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "algorithm/scene/camera.h"

namespace sgs {

// Cameras of `camera_path`: camera_to_world, 16 numbers row by row with x right, y up, z backward
// axes, and fov, the degrees that render_height spans; of the size render_width x render_height.
// origin: the file, for messages. Throws InputError: a key that is missing or no number, a pose
// that is none, another camera_type than perspective, a crop.
std::vector<Camera> nerfstudio_cameras_of(const nlohmann::ordered_json& document,
                                          const std::string& origin);

}  // namespace sgs
