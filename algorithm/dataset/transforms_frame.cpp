// Keys of transforms_frame.h.
#include "algorithm/dataset/transforms_frame.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_json.h"

namespace sgs {

TransformsFrame::TransformsFrame(const Json& file, const Json& frame, std::string where)
    : file_(file), frame_(frame), where_(std::move(where)) {
  if (!frame.is_object()) {
    throw InputError(fmt::format("{}: got {}, expected an object", where_, frame.type_name()));
  }
}

void TransformsFrame::fail(const std::string& key, const std::string& got,
                           const char* expected) const {
  throw InputError(fmt::format("{}: {}: got {}, expected {}", where_, key, got, expected));
}

const TransformsFrame::Json* TransformsFrame::find(const char* key) const {
  for (const Json* object : {&frame_, &file_}) {
    const auto found = object->find(key);
    if (found != object->end()) return &*found;
  }
  return nullptr;
}

double TransformsFrame::finite(const std::string& key, const Json& value) const {
  if (!value.is_number() || !std::isfinite(value.get<double>())) {
    fail(key, shown(value), "a finite number");
  }
  return value.get<double>();
}

std::optional<double> TransformsFrame::number(const char* key) const {
  const Json* value = find(key);
  if (value == nullptr) return {};
  return finite(key, *value);
}

std::optional<std::string> TransformsFrame::text(const char* key) const {
  const Json* value = find(key);
  if (value == nullptr) return {};
  if (!value->is_string()) fail(key, shown(*value), "a text");
  return value->get<std::string>();
}

glm::dmat4 TransformsFrame::matrix(const char* key) const {
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

namespace {

void refuse_distortion(const TransformsFrame& frame) {
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

int size_of(const TransformsFrame& frame, const char* key, int of_image) {
  const auto size = frame.number(key);
  if (!size) return of_image;
  if (!(*size >= 1 && *size <= INT32_MAX) || *size != std::floor(*size)) {
    frame.fail(key, fmt::format("{}", *size), "a whole number of px from 1");
  }
  return static_cast<int>(*size);
}

// From the focal length itself or from the angle that `size` px take.
std::optional<double> focal_of(const TransformsFrame& frame, const char* key, const char* angle_key,
                               int size) {
  if (const auto focal_px = frame.number(key)) return focal_px;
  const auto angle = frame.number(angle_key);
  if (!angle) return {};
  if (!(*angle > 0 && *angle < M_PI)) {
    frame.fail(angle_key, fmt::format("{}", *angle), "radians between 0 and pi");
  }
  return 0.5 * size / std::tan(0.5 * *angle);
}

}  // namespace

Intrinsics transforms_intrinsics(const TransformsFrame& frame, const ImageHeader& image) {
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

}  // namespace sgs
