// Reading of paths, and frames between keys.
#include "testbench/streaminggs/run/camera_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "algorithm/dataset/view_cameras.h"
#include "algorithm/files/input_error.h"
#include "algorithm/files/input_json.h"
#include "algorithm/scene/camera.h"
#include "testbench/builtin/builtin_scene.h"
#include "testbench/streaminggs/report/json_place.h"

namespace sgs {
namespace {

constexpr const char* kBuiltinPath = "builtin:path";

CameraPath read_object(const JsonPlace& place, const std::string& file) {
  CameraPath path;
  path.keys = cameras_of(place.at("cameras").json(), file + ": cameras");
  place.each([&](const std::string& key, const JsonPlace& value) {
    if (key == "closed") {
      if (!value.json().is_boolean()) value.fail("true or false");
      path.closed = value.json().get<bool>();
    } else if (key != "cameras") {
      value.fail("no key but cameras and closed");
    }
  });
  return path;
}

CameraPath read_file(const std::string& file) {
  std::error_code unknown;
  CameraPath path;
  const auto take = [&](ViewCameras read) {
    path.keys = std::move(read.cameras);
    path.note = std::move(read.note);
  };
  if (std::filesystem::is_directory(file, unknown)) {
    take(read_view_cameras(file));
  } else {
    const nlohmann::ordered_json json = read_json(file);
    const bool others =
        json.is_object() && (json.contains("frames") || json.contains("camera_path"));
    if (json.is_object() && !others) {
      path = read_object(JsonPlace(file, json), file);
    } else {
      take(view_cameras_of(json, file));
    }
  }
  path.name = file;
  return path;
}

}  // namespace

bool is_path_file(const std::string& path) { return path != kBuiltinPath; }

CameraPath read_camera_path(const std::string& path, const std::string& scene) {
  CameraPath read;
  if (is_path_file(path)) {
    read = read_file(path);
  } else {
    if (!is_builtin_scene(scene)) {
      throw InputError(
          fmt::format("--path: got {} with {}, which is no built-in scene, expected "
                      "a file of cameras",
                      path, scene));
    }
    BuiltinPath own = builtin_path(scene);
    read = {fmt::format("the {} of {}", own.name, scene), std::move(own.keys), own.closed, ""};
  }
  if (read.keys.size() < 2) {
    throw InputError(
        fmt::format("{}: got {} cameras, expected two or more to go from one to the "
                    "next",
                    read.name, read.keys.size()));
  }
  return read;
}

std::vector<Camera> frames_along(const CameraPath& path, std::uint32_t count) {
  const std::vector<Camera>& keys = path.keys;
  for (std::size_t i = 1; i < keys.size(); ++i) {
    if (keys[i].width == keys[0].width && keys[i].height == keys[0].height) continue;
    throw InputError(
        fmt::format("{}: camera {}: got {}x{} px, expected the {}x{} of the first, or "
                    "--size for all",
                    path.name, i, keys[i].width, keys[i].height, keys[0].width, keys[0].height));
  }
  const double legs = static_cast<double>(path.closed ? keys.size() : keys.size() - 1);
  const double steps = path.closed ? count : std::max(count, 2U) - 1;
  std::vector<Camera> frames;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double along = legs * i / steps;
    // The last frame of an open path is at the end of its last leg.
    const double leg = std::min(std::floor(along), legs - 1);
    const auto from = static_cast<std::size_t>(leg);
    const Camera &a = keys[from], &b = keys[(from + 1) % keys.size()];
    const double t = along - leg;
    Camera frame = camera_between(a, b, t);
    frame.focal_x = (1 - t) * a.focal_x + t * b.focal_x;
    frame.focal_y = (1 - t) * a.focal_y + t * b.focal_y;
    frame.principal_offset = (1 - t) * a.principal_offset + t * b.principal_offset;
    frame.id = static_cast<int>(i);
    frame.name = fmt::format("frame_{}", i);
    frames.push_back(frame);
  }
  return frames;
}

}  // namespace sgs
