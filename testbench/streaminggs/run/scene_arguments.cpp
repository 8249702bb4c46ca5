// Scene, camera and size arguments.
#include "testbench/streaminggs/run/scene_arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <sstream>

#include "algorithm/files/input_error.h"
#include "algorithm/scene/camera.h"
#include "algorithm/splat/view.h"
#include "testbench/builtin/builtin_scene.h"
#include "testbench/builtin/open_scene.h"
#include "testbench/command_line/guard.h"

namespace sgs {
namespace {

constexpr std::uint32_t kMostLevel = 1000;
constexpr int kMaxSizePx = 65536;  // sub-tile bounds are 16-bit numbers

bool read_int(const std::string& text, int& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

std::pair<int, int> parse_size(const std::string& size) {
  const std::size_t cross = size.find('x');
  int width = 0, height = 0;
  if (cross == std::string::npos || !read_int(size.substr(0, cross), width) ||
      !read_int(size.substr(cross + 1), height) || width < 1 || height < 1 || width > kMaxSizePx ||
      height > kMaxSizePx) {
    throw InputError(
        fmt::format("--size: got '{}', expected WIDTHxHEIGHT, each 1 to {}", size, kMaxSizePx));
  }
  return {width, height};
}

// Describes how a frame of another shape than the camera's stretches the picture; empty where
// rounding explains it.
std::string stretch_of(const std::string& size, int view, const Camera& camera, PixelSize frame) {
  const double rows = static_cast<double>(camera.height) * frame.width / camera.width;
  if (std::abs(rows - frame.height) < 1) return "";
  return fmt::format(
      "--size {}: view {} has {}x{} px: its fields of view are kept, so the picture is stretched; "
      "{}x{} keeps its shape",
      size, view, camera.width, camera.height, frame.width, std::max(1L, std::lround(rows)));
}

void check_drawable(const Camera& camera, const std::string& origin) {
  try {
    sgs::check_drawable(camera);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", origin, error.what()));
  }
}

// The numbers that `view` names out of 0 to count - 1, in its order.
std::vector<int> chosen_numbers(const std::string& view, int count) {
  std::vector<int> numbers;
  if (view == "all") {
    numbers.resize(static_cast<std::size_t>(count));
    std::iota(numbers.begin(), numbers.end(), 0);
    return numbers;
  }
  std::istringstream parts(view + ",");
  for (std::string part; std::getline(parts, part, ',');) {
    int number = 0;
    if (!read_int(part, number) || number < 0 || number >= count ||
        std::find(numbers.begin(), numbers.end(), number) != numbers.end()) {
      throw InputError(fmt::format(
          "--view{}: got '{}', expected all, or numbers from 0 to {}, each once, as in 0,2",
          part == view ? "" : " " + view, part, count - 1));
    }
    numbers.push_back(number);
  }
  return numbers;
}

}  // namespace

void SceneArguments::add_scene_to(CommandLine& line, const char* forms) {
  scene_forms = forms;
  line.text("SCENE", scene, forms, Given::kAlways);
  add_reading_to(line);
}

void SceneArguments::add_reading_to(CommandLine& line) {
  line.flag(
      "--drop-invalid", drop_invalid,
      "leave out Gaussians with values that are not finite or too large to be drawn, and count "
      "them");
  line.whole("--level", level, 0, kMostLevel,
             "of a scene with levels of detail, from 0, the finest, which is the default");
  line.text("--scene-axes", axes,
            "where x, y and z of the scene point, as in rub for right, up, back, which .spz files "
            "ought to have: it is turned to right, down, forward; as it is stored if not given");
}

void SceneArguments::add_views_to(CommandLine& line) {
  line.file("--cameras", cameras_path,
            "cameras.json, transforms.json, a camera path of nerfstudio, or the folder of a COLMAP "
            "model or a data set; built-in scenes bring their own");
  add_choice_of_views_to(line);
}

void SceneArguments::add_choice_of_views_to(CommandLine& line) {
  line.text("--view", view, "numbers of cameras, as in 0,2, or all");
  line.text("--size", size, "WIDTHxHEIGHT in px; scales the intrinsics");
}

void SceneArguments::add_weighing_to(CommandLine& line) {
  line.numbers("--weigh-by", weigh_by,
               "numbers of the cameras that weigh the Gaussians for vector quantisation, as in "
               "0,2,3; all if not given");
}

void SceneArguments::add_cache_to(CommandLine& line) {
  line.file("--cache", cache,
            "folder that keeps codebooks for later runs, or off; if not given, $STREAMINGGS_CACHE, "
            "or streaminggs in $XDG_CACHE_HOME or ~/.cache");
}

std::string SceneArguments::default_out(const std::string& config_name) const {
  std::string name = scene_name(scene);
  if (is_builtin_scene(scene)) {
    name = scene.substr(scene.find(':') + 1);
    name = name.substr(0, name.find('?'));
  }
  return (std::filesystem::path("out") / name / config_name).string();
}

void SceneArguments::add_inputs_to(OutputPlan& plan) const {
  for (const std::string& file : files_of_scene(scene, reading())) plan.add_input(file);
  std::error_code unknown;
  if (!std::filesystem::is_directory(cameras_path, unknown)) return plan.add_input(cameras_path);
  for (const std::string& file : read_view_cameras(cameras_path).files) plan.add_input(file);
}

void SceneArguments::check_file() const {
  std::error_code unknown;
  if (is_builtin_scene(scene)) return;
  if (!std::filesystem::exists(scene, unknown)) {
    throw InputError(fmt::format("{}: no such file, expected {}", scene, scene_forms));
  }
  if (is_scene_file(scene)) return;
  if (std::filesystem::is_directory(scene, unknown)) {
    throw InputError(fmt::format("{}: got a folder, expected {}", scene, scene_forms));
  }
  throw InputError(fmt::format("{}: got the extension \"{}\", expected {}", scene,
                               std::filesystem::path(scene).extension().string(), scene_forms));
}

Scene SceneArguments::load() const {
  Scene loaded = load_silently();
  for (const std::string& note : loaded.notes) {
    fmt::print(stderr, "streaminggs: note: {}\n", one_line(scene + ": " + note));
  }
  return loaded;
}

Scene SceneArguments::load_silently() const {
  check_file();
  Scene loaded = while_doing("reading " + scene, [&] { return open_scene(scene, reading()); });
  if (loaded.dropped_invalid > 0 && loaded.cloud.size() == 0) {
    throw InputError(
        fmt::format("{}: --drop-invalid leaves none of {} Gaussians, expected one or more", scene,
                    loaded.dropped_invalid));
  }
  return loaded;
}

std::optional<PackedScene> SceneArguments::load_packed() const {
  if (!is_image_file(scene)) return {};
  refuse_reading("is packed already");
  if (!weigh_by.empty()) {
    throw InputError(fmt::format(
        "--weigh-by: {} is packed already, expected it where the scene is packed", scene));
  }
  return while_doing("reading " + scene, [&] { return read_image_file(scene); });
}

void SceneArguments::refuse_reading(const std::string& what) const {
  for (const char* given : {drop_invalid ? "--drop-invalid" : nullptr, level ? "--level" : nullptr,
                            axes.empty() ? nullptr : "--scene-axes"}) {
    if (given == nullptr) continue;
    throw InputError(fmt::format("{}: {} {}, expected a file of Gaussians", given, scene, what));
  }
}

ViewCameras SceneArguments::all_cameras(const std::vector<Camera>& own) const {
  if (cameras_path.empty()) return {own, {}, "", {}};
  ViewCameras read = read_view_cameras(cameras_path);
  if (read.cameras.empty()) {
    throw InputError(fmt::format("{}: holds no cameras, expected one or more", cameras_path));
  }
  return read;
}

ChosenCameras SceneArguments::chosen_cameras(const std::vector<Camera>& own) const {
  const ViewCameras read = all_cameras(own);
  const std::vector<Camera>& all = read.cameras;
  if (all.empty()) {
    throw InputError(fmt::format("{}: brings no cameras: --cameras FILE is needed", scene));
  }
  std::vector<std::pair<int, Camera>> chosen;
  for (const int number : chosen_numbers(view, static_cast<int>(all.size()))) {
    chosen.emplace_back(number, all[static_cast<std::size_t>(number)]);
  }
  ChosenCameras sized = in_size(std::move(chosen), origin_of_cameras());
  if (!read.note.empty()) sized.notes.push_back(cameras_path + ": " + read.note);
  return sized;
}

ChosenCameras SceneArguments::in_size(std::vector<std::pair<int, Camera>> cameras,
                                      const std::string& origin) const {
  ChosenCameras chosen{std::move(cameras), {}};
  for (auto& [index, camera] : chosen.views) {
    if (!size.empty()) {
      const auto [width, height] = parse_size(size);
      const std::string stretch = stretch_of(size, index, camera, {width, height});
      if (chosen.notes.empty() && !stretch.empty()) chosen.notes.push_back(stretch);
      camera = scaled_to(camera, width, height);
    }
    if (camera.width > kMaxSizePx || camera.height > kMaxSizePx) {
      throw InputError(
          fmt::format("{}: view {}: got {}x{} px, expected at most {} a side, or --size", origin,
                      index, camera.width, camera.height, kMaxSizePx));
    }
    check_drawable(camera, origin);
  }
  return chosen;
}

std::vector<std::pair<int, Camera>> SceneArguments::cameras(const std::vector<Camera>& own) const {
  ChosenCameras chosen = chosen_cameras(own);
  for (const std::string& note : chosen.notes) fmt::print("{}\n", note);
  return std::move(chosen.views);
}

std::vector<PixelSize> SceneArguments::frame_sizes() const {
  if (!size.empty()) {
    const auto [width, height] = parse_size(size);
    return {{width, height}};
  }
  std::vector<Camera> own;
  if (cameras_path.empty()) {
    if (!is_builtin_scene(scene)) return {};
    own = load().cameras;
  }
  std::vector<PixelSize> sizes;
  for (const auto& [number, camera] : chosen_cameras(own).views) {
    sizes.push_back({camera.width, camera.height});
  }
  return sizes;
}

std::vector<Camera> SceneArguments::weighing_cameras(const std::vector<Camera>& own,
                                                     SecondHalfEncoding encoding) const {
  std::vector<Camera> all = all_cameras(own).cameras;
  const bool quantised = SecondHalfFormat{encoding, 0, {}}.quantised();
  if (!weigh_by.empty() && !quantised) {
    throw InputError(fmt::format(
        "--weigh-by: got it with storage.encoding {}, which has no codebooks, expected vq or "
        "vq_packed",
        kEncodingNames[static_cast<std::size_t>(encoding)]));
  }
  std::vector<Camera> chosen;
  for (const int number : weigh_by) {
    if (number < 0 || number >= static_cast<int>(all.size())) {
      throw InputError(fmt::format("--weigh-by: got {}, expected 0 to {}", number,
                                   static_cast<int>(all.size()) - 1));
    }
    chosen.push_back(all[static_cast<std::size_t>(number)]);
  }
  if (weigh_by.empty()) chosen = std::move(all);
  if (quantised) {
    for (const Camera& camera : chosen) check_drawable(camera, origin_of_cameras());
  }
  return chosen;
}

}  // namespace sgs
