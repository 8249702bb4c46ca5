// Reading of paths, and frames between keys.
#include "testbench/streaminggs/run/camera_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "algorithm/files/input_error.h"
#include "algorithm/scene/camera.h"
#include "testbench/builtin/builtin_scene.h"

namespace sgs {
namespace {

constexpr const char *kBuiltin = "builtin:", *kBuiltinPath = "builtin:path";

}  // namespace

bool is_path_file(const std::string& path) { return path != kBuiltinPath; }

CameraPath read_camera_path(const std::string& path, const std::string& scene) {
  CameraPath read;
  if (is_path_file(path) && path.rfind(kBuiltin, 0) == 0) {
    throw InputError(
        fmt::format("--path: got {}, expected {}, the way that comes with a built-in scene, or a "
                    "file of cameras",
                    path, kBuiltinPath));
  }
  if (is_path_file(path)) {
    ViewCameras cameras = read_view_cameras(path);
    read = {path, std::move(cameras.cameras), cameras.path, std::move(cameras.note)};
  } else {
    if (!is_builtin_scene(scene)) {
      throw InputError(
          fmt::format("--path: got {} with {}, which is no built-in scene, expected "
                      "a file of cameras",
                      path, scene));
    }
    BuiltinPath own = builtin_path(scene);
    read = {fmt::format("the {} of {}", own.name, scene),
            std::move(own.keys),
            {own.closed, false, {}},
            ""};
  }
  if (read.keys.size() < 2) {
    throw InputError(
        fmt::format("{}: got {} cameras, expected two or more to go from one to the "
                    "next",
                    read.name, read.keys.size()));
  }
  return read;
}

std::vector<Camera> frames_along(const CameraPath& path, std::optional<std::uint32_t> wanted) {
  constexpr std::uint32_t kUsual = 60;
  const std::vector<Camera>& keys = path.keys;
  for (std::size_t i = 1; i < keys.size(); ++i) {
    if (keys[i].width == keys[0].width && keys[i].height == keys[0].height) continue;
    throw InputError(
        fmt::format("{}: camera {}: got {}x{} px, expected the {}x{} of the first, or "
                    "--size for all",
                    path.name, i, keys[i].width, keys[i].height, keys[0].width, keys[0].height));
  }
  if (path.facts.each_frame && !wanted) return keys;
  const std::uint32_t count = wanted.value_or(kUsual);
  const double legs = static_cast<double>(path.facts.closed ? keys.size() : keys.size() - 1);
  const double steps = path.facts.closed ? count : std::max(count, 2U) - 1;
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
