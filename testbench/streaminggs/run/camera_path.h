// Key cameras that a picture follows, one frame after the other.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "algorithm/scene/camera.h"

namespace sgs {

struct CameraPath {
  std::string name;  // name in messages: its file, or the scene that it belongs to
  std::vector<Camera> keys;
  bool closed = false;  // from the last key back to the first
  std::string note;     // as ViewCameras has it
};

// Reads a path: an object {cameras, closed}, or whatever read_view_cameras() takes, which is open.
// The name `builtin:path` stands for the way that comes with a built-in scene. scene: what the
// command calls it. Throws InputError as read_view_cameras and builtin_path do; for another key;
// for fewer than two cameras; for `builtin:path` with a scene that is none.
CameraPath read_camera_path(const std::string& path, const std::string& scene);

// True if `path` is the name of a file.
bool is_path_file(const std::string& path);

// `count` cameras, at least 1, from the first key to the last, as many between two keys as between
// any other two: on the line between their centres, turned the shortest way, focal lengths in
// proportion. A closed path ends where the next frame would be the first. Throws InputError where
// keys differ in size.
std::vector<Camera> frames_along(const CameraPath& path, std::uint32_t count);

}  // namespace sgs
