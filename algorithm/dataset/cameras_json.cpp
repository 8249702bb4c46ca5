// cameras.json of the original, and the camera paths that nerfstudio's viewer writes
// (nerfstudio/cameras/camera_paths.py, nerfstudio/scripts/render.py).
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "algorithm/dataset/json_camera.h"
#include "algorithm/dataset/layout.h"

namespace sgs {
namespace {

namespace fs = std::filesystem;

fs::path file_in(const std::string& folder) { return fs::path(folder) / "cameras.json"; }

StatedView view_of_entry(const JsonPlace& entry) {
  StatedView view;
  view.where = entry.name();
  view.folders = {"images", ""};
  view.id = static_cast<int>(entry.at("id", "a whole number").whole(-INT32_MAX, INT32_MAX));
  view.image = entry.at("img_name", "a text").text();
  if (const auto mask = entry.find("mask_path")) view.mask = mask->text();
  Intrinsics& intrinsics = view.intrinsics;
  intrinsics.width = size_px(entry.at("width", "a whole number of px"));
  intrinsics.height = size_px(entry.at("height", "a whole number of px"));
  intrinsics.focal_x = entry.at("fx", "a focal length in px").number();
  intrinsics.focal_y = entry.at("fy", "a focal length in px").number();
  if (const auto x = entry.find("cx")) intrinsics.centre_x = x->number();
  if (const auto y = entry.find("cy")) intrinsics.centre_y = y->number();
  intrinsics.lens = lens_of(entry);
  const std::vector<double> position = entry.at("position", "3 numbers").numbers(3);
  const JsonPlace rotation = entry.at("rotation", "3 rows of 3 numbers");
  glm::dmat4 world_from_camera = matrix_of(rotation, 3);
  world_from_camera[3] = {position[0], position[1], position[2], 1};
  view.pose = opencv_pose(world_from_camera, rotation.name());
  return view;
}

double focal_px(const JsonPlace& fov, int height) {
  const double degrees = fov.number();
  if (!(degrees > 0 && degrees < 180)) fov.refuse("degrees between 0 and 180");
  return 0.5 * height / std::tan(0.5 * degrees * M_PI / 180);
}

StatedView view_of_frame(const JsonPlace& frame, int width, int height, std::size_t number) {
  StatedView view;
  view.where = frame.name();
  view.image = fmt::format("frame_{:05}", number);
  view.intrinsics.width = width;
  view.intrinsics.height = height;
  view.intrinsics.focal_x = focal_px(frame.at("fov", "degrees between 0 and 180"), height);
  view.intrinsics.lens = lens_of(frame);
  const JsonPlace matrix = frame.at("camera_to_world", "16 numbers, row by row");
  const std::vector<double> numbers = matrix.numbers();
  if (numbers.size() != 16) {
    matrix.refuse(fmt::format("{} numbers", numbers.size()), "16, row by row");
  }
  glm::dmat4 world_from_camera(1.0);
  for (int i = 0; i < 16; ++i) {
    world_from_camera[i % 4][i / 4] = numbers[static_cast<std::size_t>(i)];
  }
  view.pose = opengl_pose(world_from_camera, matrix.name());
  return view;
}

double above_0(const JsonPlace& place) {
  constexpr double kMost = 1e6;
  const double number = place.number();
  if (!(number > 0 && number <= kMost)) place.refuse(fmt::format("above 0, at most {}", kMost));
  return number;
}

// nerfstudio draws all frames in `seconds`; `fps` is what they were made with.
PathFacts facts_of(const JsonPlace& file, StatedDataset& dataset) {
  const auto frames = static_cast<double>(dataset.views.size());
  PathFacts path;
  path.each_frame = true;
  const auto fps = file.find("fps"), seconds = file.find("seconds");
  if (fps) path.frame_rate = above_0(*fps);
  if (seconds) {
    const double rate = frames / above_0(*seconds);
    // As many as the seconds hold, rounded either way.
    if (fps && !(std::abs(*path.frame_rate * seconds->number() - frames) <= 1)) {
      dataset.unread_keys[fmt::format("fps of {}, where {} frames in {} s are {:.4g} a second",
                                      *path.frame_rate, frames, seconds->number(), rate)] = 1;
      path.frame_rate = rate;
    }
    if (!fps) path.frame_rate = rate;
  }
  if (const auto closed = file.find("is_cycle")) path.closed = closed->flag();
  return path;
}

}  // namespace

bool holds_cameras_json(const std::string& folder) {
  std::error_code unknown;
  return fs::exists(file_in(folder), unknown);
}

StatedDataset read_cameras_json(const std::string& folder) {
  const std::string path = file_in(folder).string();
  return views_of_cameras_json(read_json(path), path);
}

StatedDataset views_of_cameras_json(const nlohmann::ordered_json& document,
                                    const std::string& path) {
  static const std::vector<std::string> kKeys = {"id",       "img_name", "width",    "height",
                                                 "position", "rotation", "fx",       "fy",
                                                 "cx",       "cy",       "mask_path"};
  StatedDataset dataset;
  dataset.files = {path};
  JsonPlace list(path, document);
  if (document.is_object()) {
    list.expect_only({"cameras", "closed"});
    if (const auto closed = list.find("closed")) dataset.path.closed = closed->flag();
    list = list.at("cameras");
  }
  for (const JsonPlace& element : list.elements("an array of cameras")) {
    const JsonPlace entry(fmt::format("{}: camera {}", list.name(), dataset.views.size()),
                          element.json());
    dataset.views.push_back(view_of_entry(entry));
    count_unread(entry, kKeys, dataset.unread_keys);
  }
  return dataset;
}

StatedDataset views_of_camera_path(const nlohmann::ordered_json& document,
                                   const std::string& path) {
  // What frames were made of is in them.
  static const std::vector<std::string> kKeys = {"camera_path",  "camera_type",
                                                 "render_width", "render_height",
                                                 "fps",          "seconds",
                                                 "is_cycle",     "crop",
                                                 "keyframes",    "default_fov",
                                                 "type",         "smoothness_value",
                                                 "smoothness",   "default_transition_sec"};
  static const std::vector<std::string> kFrameKeys = {"camera_to_world", "fov", "aspect",
                                                      "camera_type"};
  StatedDataset dataset;
  dataset.files = {path};
  const JsonPlace file(path, document);
  const auto expect_perspective = [](const JsonPlace& of) {
    const auto type = of.find("camera_type");
    if (type && type->text() != "perspective") type->refuse(type->text(), "perspective");
  };
  expect_perspective(file);
  if (const auto crop = file.find("crop"); crop && !crop->json().is_null()) {
    crop->refuse("null: the whole scene is drawn");
  }
  const int width = size_px(file.at("render_width", "a whole number of px"));
  const int height = size_px(file.at("render_height", "a whole number of px"));
  for (const JsonPlace& frame : file.at("camera_path").elements("an array of cameras")) {
    dataset.views.push_back(
        view_of_frame(frame.with_defaults(document), width, height, dataset.views.size()));
    expect_perspective(frame);
    count_unread(frame, kFrameKeys, dataset.unread_keys);
  }
  count_unread(file, kKeys, dataset.unread_keys);
  dataset.path = facts_of(file, dataset);
  return dataset;
}

}  // namespace sgs
