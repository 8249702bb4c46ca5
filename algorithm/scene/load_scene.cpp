// The choice of the format for load_scene.h.
#include "algorithm/scene/load_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <utility>

#include "algorithm/files/input_error.h"
#include "algorithm/scene/ply_reader.h"

namespace sgs {

bool is_scene_file(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension == ".ply";
}

Scene load_scene(const std::string& path, const SceneReadOptions& options) {
  const std::filesystem::path file(path);
  if (!is_scene_file(path)) {
    throw InputError(fmt::format("{}: got the extension \"{}\", expected a .ply file", path,
                                 file.extension().string()));
  }
  SceneContents read = read_ply(path, options);
  return {
      file.stem().string(), std::move(read.cloud), {}, read.dropped_invalid, std::move(read.notes)};
}

}  // namespace sgs
