// One entrance for whatever the command line calls a SCENE.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "algorithm/scene/camera.h"
#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/scene/ply_reader.h"

namespace sgs {

struct Scene {
  std::string name;  // file name without folder and extension, or NAME of builtin:NAME
  GaussianCloud cloud;
  std::vector<Camera> cameras;        // of a built-in scene; a .ply brings none
  std::uint64_t dropped_invalid = 0;  // Gaussians left out, see PlyReadOptions
};

// Loads a .ply file or makes a scene "builtin:NAME?n=...". Throws InputError as read_ply and
// make_builtin_scene do, and when `spec` is neither.
Scene load_scene(const std::string& spec, const PlyReadOptions& options = {});

}  // namespace sgs
