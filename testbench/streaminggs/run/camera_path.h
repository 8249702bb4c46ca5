// Key cameras that a picture follows, one frame after the other.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "algorithm/dataset/view_cameras.h"
#include "algorithm/scene/camera.h"

namespace sgs {

struct CameraPath {
  std::string name;  // name in messages: its file, or the scene that it belongs to
  std::vector<Camera> keys;
  PathFacts facts;
  std::string note;  // as ViewCameras has it
};

// Reads a path: whatever read_view_cameras() takes, or `builtin:path`, the way that comes with a
// built-in scene. scene: what the command calls it. Throws InputError as read_view_cameras and
// builtin_path do; for fewer than two cameras; for `builtin:path` with a scene that is none.
CameraPath read_camera_path(const std::string& path, const std::string& scene);

// True if `path` is the name of a file.
bool is_path_file(const std::string& path);

// So many cameras as `wanted` says, at least 1, else 60, from the first key to the last, as many
// between two keys as between any other two: on the line between their centres, turned the shortest
// way, focal lengths in proportion. A closed path ends where the next frame would be the first. Of
// a path that states each frame, where none is wanted: these. Throws InputError where keys differ
// in size.
std::vector<Camera> frames_along(const CameraPath& path, std::optional<std::uint32_t> wanted);

}  // namespace sgs
