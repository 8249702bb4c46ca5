// Cameras to draw from, of whatever file or folder states them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "algorithm/scene/camera.h"

namespace sgs {

// What a file says of its cameras as a path.
struct PathFacts {
  bool closed = false;               // the first follows the last
  bool each_frame = false;           // a camera is there for each frame
  std::optional<double> frame_rate;  // frames a second
};

struct ViewCameras {
  std::vector<Camera> cameras;  // each with its principal point; id: its place, but of cameras.json
  std::vector<std::string> files;  // that they were read from
  // A sentence where cameras have lenses with distortion, or names were not read; else empty.
  std::string note;
  PathFacts path;
};

// Of a file: cameras.json, such an array with `closed` in an object, transforms.json or a camera
// path of nerfstudio, all in their order, or a file of a COLMAP model. Of a folder: a COLMAP model,
// or any data set, in the order that open_dataset() gives its views. No image has to be there but
// where nothing else states the size. A lens with distortion is taken for a pinhole of its focal
// lengths and size. Throws InputError with file, entry, what was found and what was expected.
ViewCameras read_view_cameras(const std::string& path);

}  // namespace sgs
