// A scene out of a file, whatever its form. README.md has the table of forms.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "algorithm/scene/camera.h"
#include "algorithm/scene/gaussian_cloud.h"

namespace sgs {

struct Scene {
  std::string name;
  GaussianCloud cloud;
  std::vector<Camera> cameras;          // where the source brings some; a file does not
  std::uint64_t dropped_invalid = 0;    // Gaussians left out, see SceneReadOptions
  std::string form = {};                // of the file, in words
  std::string axes = {};                // that it was turned from; empty where it was not
  std::vector<std::string> notes = {};  // see SceneContents
};

// The name of a scene: that of its file without folder and extension, of its folder where that is
// the scene. "room" of room.spz and of room/meta.json.
std::string scene_name(const std::string& path);

// True where there is something at `path` that begins, or is named, as a form of scene does.
bool is_scene_file(const std::string& path);

// Recognises the form, then reads. Throws InputError for what is of no form, for a form that cannot
// be drawn, which it names, and for whatever the reader of the form refuses.
Scene load_scene(const std::string& path, const SceneReadOptions& options = {});

// How their names end: ".ply, .spz, ...".
std::string scene_endings();

// The files that load_scene() opens for it, in the order of their paths. Throws InputError where
// they cannot be told; what is no scene is given back as it is.
std::vector<std::string> files_of_scene(const std::string& path,
                                        const SceneReadOptions& options = {});

}  // namespace sgs
