// One entrance for whatever the command line calls a SCENE, but for packed ones.
#pragma once

#include <string>

#include "algorithm/scene_files/load_scene.h"

namespace sgs {

// Loads a file as load_scene does, or makes a scene "builtin:NAME?n=...", which brings its cameras.
// Throws InputError as load_scene and make_builtin_scene do, and when `spec` is neither.
Scene open_scene(const std::string& spec, const SceneReadOptions& options = {});

}  // namespace sgs
