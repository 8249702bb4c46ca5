// A scene out of a file.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "algorithm/scene/camera.h"
#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/scene/scene_contents.h"

namespace sgs {

struct Scene {
  std::string name;  // file name without folder and extension
  GaussianCloud cloud;
  std::vector<Camera> cameras;          // where the source brings some; a .ply does not
  std::uint64_t dropped_invalid = 0;    // Gaussians left out, see SceneReadOptions
  std::vector<std::string> notes = {};  // see SceneContents
};

// True if the file's name ends as load_scene() takes it.
bool is_scene_file(const std::string& path);

// Loads a .ply file. Throws InputError as read_ply does, and for any other extension.
Scene load_scene(const std::string& path, const SceneReadOptions& options = {});

}  // namespace sgs
