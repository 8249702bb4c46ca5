// transforms.json and its kin (layouts.h).
#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "algorithm/dataset/image_search.h"
#include "algorithm/dataset/layouts.h"
#include "algorithm/dataset/stated_view.h"
#include "algorithm/dataset/transforms_frame.h"
#include "algorithm/files/input_error.h"
#include "algorithm/files/input_json.h"

namespace sgs {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

fs::path file_in(const std::string& folder, const char* name) { return fs::path(folder) / name; }

bool is_in(const std::string& folder, const char* name) {
  std::error_code unknown;
  return fs::exists(file_in(folder, name), unknown);
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
      const TransformsFrame frame(json_, frames[i], fmt::format("{}: frame {}", path_, i));
      const auto file = frame.text("file_path");
      if (!file) frame.fail("file_path", "nothing", "the path of an image");
      use(*file, [&](Split split) { return view_of(frame, *file, split); });
    }
  }

  // The file of points that goes with the frames, where it is named or there.
  std::optional<std::string> points_path() const {
    const auto found = json_.find("ply_file_path");
    if (found == json_.end()) return points_file_in(folder_.string());
    if (!found->is_string()) {
      throw InputError(
          fmt::format("{}: ply_file_path: got {}, expected a path", path_, shown(*found)));
    }
    return (folder_ / found->get<std::string>()).lexically_normal().string();
  }

  // The names of views under `key`, if it is there: all of them of frames.
  std::optional<std::set<std::string>> names(const char* key) const {
    const auto found = json_.find(key);
    if (found == json_.end()) return {};
    std::set<std::string> of_frames, names;
    for_frames([&](const std::string& file, const auto&) { of_frames.insert(view_name(file)); });
    for (const Json& path : *found) {
      const std::string name = path.is_string() ? view_name(path.get<std::string>()) : "";
      if (of_frames.count(name) == 0) {
        throw InputError(fmt::format("{}: {}: got {}, expected paths of images as frames have them",
                                     path_, key, shown(path)));
      }
      names.insert(name);
    }
    return names;
  }

  void count_unread_keys(std::map<std::string, int>& counts) const {
    const auto count = [&](const Json& object) {
      for (const auto& [key, value] : object.items()) {
        if (!is_read_of_transforms(key)) ++counts[key];
      }
    };
    count(json_);
    for (const Json& frame : json_["frames"]) count(frame);
  }

 private:
  StatedView view_of(const TransformsFrame& frame, const std::string& file, Split split) const {
    StatedView view;
    view.where = frame.where();
    view.folders = {""};
    view.image = file;
    view.mask = frame.text("mask_path").value_or("");
    view.intrinsics = transforms_intrinsics(frame);
    view.pose = opengl_pose(frame.matrix("transform_matrix"), frame.where());
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

StatedDataset frames_of_transforms(const Json& document, const std::string& path) {
  const TransformsFile file(path, document);
  StatedDataset dataset;
  dataset.files = {path};
  file.for_frames(
      [&](const std::string&, const auto& view) { dataset.views.push_back(view(Split::kTrain)); });
  file.count_unread_keys(dataset.unread_keys);
  return dataset;
}

}  // namespace sgs
