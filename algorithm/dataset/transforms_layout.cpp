// transforms.json and its kin (layouts.h).
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "algorithm/dataset/find_image.h"
#include "algorithm/dataset/layouts.h"
#include "algorithm/dataset/pose.h"
#include "algorithm/input_error.h"
#include "algorithm/input_json.h"

namespace sgs {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// One of the frames; what it does not say of its camera stands at the top of the file.
class Frame {
 public:
  Frame(const Json& file, const Json& frame, std::string where)
      : file_(file), frame_(frame), where_(std::move(where)) {
    if (!frame.is_object()) {
      throw InputError(fmt::format("{}: got {}, expected an object", where_, frame.type_name()));
    }
  }

  const std::string& where() const { return where_; }

  [[noreturn]] void fail(const std::string& key, const std::string& got,
                         const char* expected) const {
    throw InputError(fmt::format("{}: {}: got {}, expected {}", where_, key, got, expected));
  }

  // Nothing where neither has the key.
  const Json* find(const char* key) const {
    for (const Json* object : {&frame_, &file_}) {
      const auto found = object->find(key);
      if (found != object->end()) return &*found;
    }
    return nullptr;
  }

  std::optional<double> number(const char* key) const {
    const Json* value = find(key);
    if (value == nullptr) return {};
    return finite(key, *value);
  }

  std::optional<std::string> text(const char* key) const {
    const Json* value = find(key);
    if (value == nullptr) return {};
    if (!value->is_string()) fail(key, shown(*value), "a text");
    return value->get<std::string>();
  }

  // 3 or 4 rows of 4 numbers.
  glm::dmat4 matrix(const char* key) const {
    const Json* rows = find(key);
    if (rows == nullptr) fail(key, "nothing", "4 rows of 4 numbers");
    if (!rows->is_array() || rows->size() < 3 || rows->size() > 4) {
      fail(key, shown(*rows), "4 rows of 4 numbers");
    }
    glm::dmat4 columns(1.0);
    for (int row = 0; row < static_cast<int>(rows->size()); ++row) {
      const Json& numbers = (*rows)[static_cast<std::size_t>(row)];
      const std::string place = fmt::format("{}[{}]", key, row);
      if (!numbers.is_array() || numbers.size() != 4) fail(place, shown(numbers), "4 numbers");
      for (int column = 0; column < 4; ++column) {
        columns[column][row] =
            finite(fmt::format("{}[{}]", place, column), numbers[static_cast<std::size_t>(column)]);
      }
    }
    return columns;
  }

 private:
  double finite(const std::string& key, const Json& value) const {
    if (!value.is_number() || !std::isfinite(value.get<double>())) {
      fail(key, shown(value), "a finite number");
    }
    return value.get<double>();
  }

  const Json& file_;
  const Json& frame_;
  std::string where_;
};

void refuse_distortion(const Frame& frame) {
  static const std::set<std::string> kUndistorted = {"OPENCV", "PINHOLE", "SIMPLE_PINHOLE",
                                                     "RADIAL", "SIMPLE_RADIAL"};
  const auto model = frame.text("camera_model");
  if (model && kUndistorted.count(*model) == 0) {
    frame.fail("camera_model", *model, "a pinhole: OPENCV or PINHOLE without distortion");
  }
  for (const char* key : {"k1", "k2", "k3", "k4", "k5", "k6", "p1", "p2"}) {
    const auto value = frame.number(key);
    if (value && *value != 0) {
      frame.fail(key, fmt::format("{}", *value), "0: images without distortion");
    }
  }
}

int size_of(const Frame& frame, const char* key, int of_image) {
  const auto size = frame.number(key);
  if (!size) return of_image;
  if (!(*size >= 1 && *size <= INT32_MAX) || *size != std::floor(*size)) {
    frame.fail(key, fmt::format("{}", *size), "a whole number of px from 1");
  }
  return static_cast<int>(*size);
}

// From the focal length itself or from the angle that `size` px take.
std::optional<double> focal_of(const Frame& frame, const char* key, const char* angle_key,
                               int size) {
  if (const auto focal_px = frame.number(key)) return focal_px;
  const auto angle = frame.number(angle_key);
  if (!angle) return {};
  if (!(*angle > 0 && *angle < M_PI)) {
    frame.fail(angle_key, fmt::format("{}", *angle), "radians between 0 and pi");
  }
  return 0.5 * size / std::tan(0.5 * *angle);
}

Intrinsics intrinsics_of(const Frame& frame, const ImageHeader& image) {
  refuse_distortion(frame);
  Intrinsics intrinsics;
  intrinsics.width = size_of(frame, "w", image.width);
  intrinsics.height = size_of(frame, "h", image.height);
  const auto x = focal_of(frame, "fl_x", "camera_angle_x", intrinsics.width);
  const auto y = focal_of(frame, "fl_y", "camera_angle_y", intrinsics.height);
  if (!x && !y) frame.fail("fl_x", "nothing", "it, or camera_angle_x");
  intrinsics.focal_x = x ? *x : *y;
  intrinsics.focal_y = y ? *y : *x;
  const auto centre_x = frame.number("cx"), centre_y = frame.number("cy");
  if (centre_x || centre_y) {
    intrinsics.principal_point = glm::dvec2(centre_x.value_or(0.5 * intrinsics.width),
                                            centre_y.value_or(0.5 * intrinsics.height));
  }
  return intrinsics;
}

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

  // Calls use(path of the image as written, view) for each frame.
  template <class Use>
  void for_frames(const Use& use) const {
    const Json& frames = json_["frames"];
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const Frame frame(json_, frames[i], fmt::format("{}: frame {}", path_, i));
      const auto file = frame.text("file_path");
      if (!file) frame.fail("file_path", "nothing", "the path of an image");
      use(*file, [&](Split split) { return view_of(frame, *file, split); });
    }
  }

  // The paths of images under `key`, if it is there.
  std::optional<std::set<std::string>> paths(const char* key) const {
    const auto found = json_.find(key);
    if (found == json_.end()) return {};
    std::set<std::string> paths;
    for (const Json& path : *found) {
      if (!path.is_string()) {
        throw InputError(
            fmt::format("{}: {}: got {}, expected paths of images", path_, key, shown(path)));
      }
      paths.insert(view_name(path.get<std::string>()));
    }
    return paths;
  }

 private:
  StatedView view_of(const Frame& frame, const std::string& file, Split split) const {
    const FoundImage found = find_image({folder_}, file, frame.where());
    return {frame.where(),
            view_name(file),
            found.path,
            found.header,
            intrinsics_of(frame, found.header),
            opengl_pose(frame.matrix("transform_matrix"), frame.where()),
            split};
  }

  std::string folder_, path_;
  Json json_;
};

}  // namespace

bool holds_split_transforms(const std::string& folder) {
  return is_in(folder, "transforms_train.json");
}

StatedDataset read_split_transforms(const std::string& folder) {
  StatedDataset dataset;
  const auto add = [&](const char* name, Split split) {
    TransformsFile(folder, name).for_frames([&](const std::string&, const auto& view) {
      dataset.views.push_back(view(split));
    });
  };
  add("transforms_train.json", Split::kTrain);
  if (is_in(folder, "transforms_test.json")) {
    add("transforms_test.json", Split::kTest);
    dataset.split_by = SplitBy::kDataset;
  }
  return dataset;
}

bool holds_transforms(const std::string& folder) { return is_in(folder, "transforms.json"); }

StatedDataset read_transforms(const std::string& folder) {
  const TransformsFile file(folder, "transforms.json");
  const auto train = file.paths("train_filenames");
  auto test = file.paths("test_filenames");
  if (!test) test = file.paths("val_filenames");
  StatedDataset dataset;
  if (train) dataset.split_by = SplitBy::kDataset;
  file.for_frames([&](const std::string& path, const auto& view) {
    const std::string name = view_name(path);
    if (!train || train->count(name) > 0) {
      dataset.views.push_back(view(Split::kTrain));
    } else if (test && test->count(name) > 0) {
      dataset.views.push_back(view(Split::kTest));
    } else {
      ++dataset.left_out;
    }
  });
  return dataset;
}

}  // namespace sgs
