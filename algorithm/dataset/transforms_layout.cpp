// transforms.json and its kin, as nerfstudio and instant-ngp write them.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "algorithm/dataset/image_search.h"
#include "algorithm/dataset/json_camera.h"
#include "algorithm/dataset/layout.h"
#include "algorithm/files/input_error.h"

namespace sgs {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

fs::path file_in(const std::string& folder, const char* name) { return fs::path(folder) / name; }

bool is_in(const std::string& folder, const char* name) {
  std::error_code unknown;
  return fs::exists(file_in(folder, name), unknown);
}

std::optional<double> number_at(const JsonPlace& frame, const char* key) {
  const auto number = frame.find(key);
  if (!number) return {};
  return number->number();
}

std::optional<double> angle_at(const JsonPlace& frame, const char* key) {
  const auto angle = frame.find(key);
  if (!angle) return {};
  if (!(angle->number() > 0 && angle->number() < M_PI)) angle->refuse("radians between 0 and pi");
  return angle->number();
}

// False where a focal length is stated that makes another angle; it is the one that is read.
bool angle_fits(const JsonPlace& frame, const char* angle, const char* focal, const char* size) {
  constexpr double kOfRounding = 0.01;
  const auto stated = number_at(frame, angle), length = number_at(frame, focal),
             size_px = number_at(frame, size);
  if (!stated || !length || !size_px) return true;
  const double made = 2 * std::atan2(*size_px / 2, *length);
  return std::abs(made - *stated) <= kOfRounding * made;
}

Intrinsics intrinsics_of(const JsonPlace& frame) {
  Intrinsics out;
  out.lens = lens_of(frame);
  if (const auto width = frame.find("w")) out.width = size_px(*width);
  if (const auto height = frame.find("h")) out.height = size_px(*height);
  out.focal_x = number_at(frame, "fl_x");
  out.focal_y = number_at(frame, "fl_y");
  if (!out.focal_x) out.angle_x = angle_at(frame, "camera_angle_x");
  if (!out.focal_y) out.angle_y = angle_at(frame, "camera_angle_y");
  const bool known = out.focal_x || out.focal_y || out.angle_x || out.angle_y;
  if (!known) frame.at("fl_x", "it, or camera_angle_x");
  out.centre_x = number_at(frame, "cx");
  out.centre_y = number_at(frame, "cy");
  return out;
}

class TransformsFile {
 public:
  TransformsFile(const fs::path& path, Json json)
      : folder_(path.parent_path()), path_(path.string()), json_(std::move(json)) {
    if (!json_.is_object() || !json_.contains("frames") || !json_["frames"].is_array()) {
      throw InputError(
          fmt::format("{}: got no frames, expected an object with an array of that name", path_));
    }
  }

  const std::string& path() const { return path_; }

  // Calls use(path of the image as written, view) for each frame.
  template <class Use>
  void for_frames(const Use& use) const {
    const Json& frames = json_["frames"];
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const JsonPlace frame =
          JsonPlace(fmt::format("{}: frame {}", path_, i), frames[i]).with_defaults(json_);
      const std::string file = frame.at("file_path", "the path of an image").text();
      use(file, [&](Split split) { return view_of(frame, file, split); });
    }
  }

  // The file of points that goes with the frames, where it is named or there.
  std::optional<std::string> points_path() const {
    const auto file = JsonPlace(path_, json_).find("ply_file_path");
    if (!file) return points_file_in(folder_.string());
    return (folder_ / file->text()).lexically_normal().string();
  }

  // The names of views under `key`, if it is there: all of them of frames.
  std::optional<std::set<std::string>> names(const char* key) const {
    const auto list = JsonPlace(path_, json_).find(key);
    if (!list) return {};
    std::set<std::string> of_frames, names;
    for_frames([&](const std::string& file, const auto&) { of_frames.insert(view_name(file)); });
    for (const JsonPlace& path : list->elements()) {
      const std::string name = view_name(path.text());
      if (of_frames.count(name) == 0) path.refuse("paths of images as frames have them");
      names.insert(name);
    }
    return names;
  }

  void count_unread_keys(std::map<std::string, int>& counts) const {
    static const std::vector<std::string> kKeys = {"frames",
                                                   "file_path",
                                                   "mask_path",
                                                   "transform_matrix",
                                                   "ply_file_path",
                                                   "train_filenames",
                                                   "test_filenames",
                                                   "val_filenames",
                                                   "w",
                                                   "h",
                                                   "fl_x",
                                                   "fl_y",
                                                   "camera_angle_x",
                                                   "camera_angle_y",
                                                   "cx",
                                                   "cy"};
    count_unread(JsonPlace(path_, json_), kKeys, counts);
    for (const Json& frame : json_["frames"]) {
      count_unread(JsonPlace(path_, frame), kKeys, counts);
      const JsonPlace with_defaults = JsonPlace(path_, frame).with_defaults(json_);
      for (const auto& [angle, focal, size] :
           {std::array{"camera_angle_x", "fl_x", "w"}, std::array{"camera_angle_y", "fl_y", "h"}}) {
        if (!angle_fits(with_defaults, angle, focal, size)) {
          ++counts[fmt::format("{}, since {} says otherwise", angle, focal)];
        }
      }
    }
  }

 private:
  StatedView view_of(const JsonPlace& frame, const std::string& file, Split split) const {
    StatedView view;
    view.where = frame.name();
    view.folders = {""};
    view.image = file;
    if (const auto mask = frame.find("mask_path")) view.mask = mask->text();
    view.intrinsics = intrinsics_of(frame);
    const JsonPlace matrix = frame.at("transform_matrix", "4 rows of 4 numbers");
    view.pose = opengl_pose(matrix_of(matrix, 4), matrix.name());
    view.split = split;
    // Where frames do not say how large their images are, one angle of all is of one shape: others
    // were cut, and nobody says where.
    view.shares_shape = (view.intrinsics.width == 0 || view.intrinsics.height == 0) &&
                        (json_.contains("camera_angle_x") || json_.contains("camera_angle_y"));
    return view;
  }

  fs::path folder_;
  std::string path_;
  Json json_;
};

TransformsFile transforms_file(const fs::path& path) { return {path, read_json(path.string())}; }

void add_points(StatedDataset& dataset, const std::optional<std::string>& path) {
  if (!path) return;
  dataset.read_points = [path = *path] { return read_points_ply(path); };
  dataset.files.push_back(*path);
}

}  // namespace

bool holds_split_transforms(const std::string& folder) {
  return is_in(folder, "transforms_train.json");
}

StatedDataset read_split_transforms(const std::string& folder) {
  StatedDataset dataset;
  const auto add = [&](const char* name, Split split) {
    const TransformsFile file = transforms_file(file_in(folder, name));
    dataset.files.push_back(file.path());
    file.for_frames(
        [&](const std::string&, const auto& view) { dataset.views.push_back(view(split)); });
    file.count_unread_keys(dataset.unread_keys);
  };
  add("transforms_train.json", Split::kTrain);
  if (is_in(folder, "transforms_test.json")) {
    add("transforms_test.json", Split::kTest);
    dataset.split_by = SplitBy::kDataset;
    dataset.tests_from = dataset.files.back() + ": frames";
  }
  // Nobody reads it here; it is the data set's all the same.
  dataset.files.push_back(file_in(folder, "transforms_val.json").string());
  add_points(dataset, points_file_in(folder));
  return dataset;
}

bool holds_transforms(const std::string& folder) { return is_in(folder, "transforms.json"); }

StatedDataset read_transforms(const std::string& folder) {
  const TransformsFile file = transforms_file(file_in(folder, "transforms.json"));
  const auto train = file.names("train_filenames");
  auto test = file.names("test_filenames");
  if (!test) test = file.names("val_filenames");
  StatedDataset dataset;
  dataset.files = {file.path()};
  if (train || test) {
    dataset.split_by = SplitBy::kDataset;
    dataset.tests_from = file.path() + ": test_filenames or val_filenames";
  }
  file.for_frames([&](const std::string& path, const auto& view) {
    const std::string name = view_name(path);
    if (test && test->count(name) > 0) {
      dataset.views.push_back(view(Split::kTest));
    } else if (!train || train->count(name) > 0) {
      dataset.views.push_back(view(Split::kTrain));
    } else {
      ++dataset.left_out;
    }
  });
  file.count_unread_keys(dataset.unread_keys);
  add_points(dataset, file.points_path());
  return dataset;
}

StatedDataset views_of_transforms(const Json& document, const std::string& path) {
  const TransformsFile file(path, document);
  StatedDataset dataset;
  dataset.files = {path};
  file.for_frames(
      [&](const std::string&, const auto& view) { dataset.views.push_back(view(Split::kTrain)); });
  file.count_unread_keys(dataset.unread_keys);
  return dataset;
}

}  // namespace sgs
