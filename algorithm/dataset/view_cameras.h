// Cameras to draw from, of whatever file or folder states them.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "algorithm/scene/camera.h"

namespace sgs {

struct ViewCameras {
  std::vector<Camera> cameras;  // each with its principal point; id: its place, but of cameras.json
  std::vector<std::string> files;  // that they were read from
  // A sentence where cameras have lenses with distortion, or names were not read; else empty.
  std::string note;
};

// Of a file: cameras.json, transforms.json or a camera path of nerfstudio, all in their order, or a
// file of a COLMAP model. Of a folder: a COLMAP model, or any data set, in the order that
// open_dataset() gives its views. No image has to be there but where nothing else states the size.
// A lens with distortion is taken for a pinhole of its focal lengths and size. Throws InputError
// with file, entry, what was found and what was expected.
ViewCameras read_view_cameras(const std::string& path);

// The same of a document that was read already from the file `path`.
ViewCameras view_cameras_of(const nlohmann::ordered_json& document, const std::string& path);

}  // namespace sgs
