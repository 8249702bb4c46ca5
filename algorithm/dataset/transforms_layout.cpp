// transforms.json and its kin (layouts.h).
#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "algorithm/dataset/layouts.h"
#include "algorithm/dataset/stated_view.h"
#include "algorithm/dataset/transforms_frame.h"
#include "algorithm/dataset/view_image.h"
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
  TransformsFile(const std::string& folder, const char* name)
      : folder_(folder), path_(file_in(folder, name).string()), json_(read_json(path_)) {
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

  // The file of points that goes with the frames, if it is named.
  std::optional<std::string> points_path() const {
    const auto found = json_.find("ply_file_path");
    if (found == json_.end()) return {};
    if (!found->is_string()) {
      throw InputError(
          fmt::format("{}: ply_file_path: got {}, expected a path", path_, shown(*found)));
    }
    return file_in(folder_, found->get<std::string>().c_str()).lexically_normal().string();
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

 private:
  StatedView view_of(const TransformsFrame& frame, const std::string& file, Split split) const {
    const FoundImage found = find_image({folder_}, file, frame.where());
    if (!frame.number("w") || !frame.number("h")) check_shape(frame, found);
    return {frame.where(),
            view_name(file),
            found.path,
            found.header,
            transforms_intrinsics(frame, found.header),
            opengl_pose(frame.matrix("transform_matrix"), frame.where()),
            split};
  }

  // Where frames do not say how large their images are, one angle of all is of one shape: others
  // were cut, and nobody says where.
  void check_shape(const TransformsFrame& frame, const FoundImage& found) const {
    if (!of_all("camera_angle_x") && !of_all("camera_angle_y")) return;
    if (!first_) first_ = found;
    const ImageHeader &one = found.header, &first = first_->header;
    if (of_one_shape(one.width, one.height, first.width, first.height)) return;
    throw InputError(fmt::format("{}: {} is {}x{} px, expected the shape of {}, {}x{} px",
                                 frame.where(), found.path, one.width, one.height, first_->path,
                                 first.width, first.height));
  }
  bool of_all(const char* key) const { return json_.contains(key); }

  std::string folder_, path_;
  Json json_;
  mutable std::optional<FoundImage> first_;  // whose shape all have
};

}  // namespace

bool holds_split_transforms(const std::string& folder) {
  return is_in(folder, "transforms_train.json");
}

StatedDataset read_split_transforms(const std::string& folder) {
  StatedDataset dataset;
  const auto add = [&](const char* name, Split split) {
    const TransformsFile file(folder, name);
    dataset.files.push_back(file.path());
    file.for_frames(
        [&](const std::string&, const auto& view) { dataset.views.push_back(view(split)); });
  };
  add("transforms_train.json", Split::kTrain);
  if (is_in(folder, "transforms_test.json")) {
    add("transforms_test.json", Split::kTest);
    dataset.split_by = SplitBy::kDataset;
    dataset.tests_from = dataset.files.back() + ": frames";
  }
  // Nobody reads it here; it is the data set's all the same.
  dataset.files.push_back(file_in(folder, "transforms_val.json").string());
  return dataset;
}

bool holds_transforms(const std::string& folder) { return is_in(folder, "transforms.json"); }

StatedDataset read_transforms(const std::string& folder) {
  const TransformsFile file(folder, "transforms.json");
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
  if (const auto points = file.points_path()) {
    dataset.points = read_points_ply(*points);
    dataset.files.push_back(*points);
  }
  return dataset;
}

}  // namespace sgs
