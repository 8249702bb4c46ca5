// One frame of transforms.json.
#pragma once

#include <glm/mat4x4.hpp>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "algorithm/dataset/stated_view.h"

namespace sgs {

// A key that a frame lacks is looked for at the top of the file. All functions throw InputError
// that begins with `where`.
class TransformsFrame {
 public:
  using Json = nlohmann::ordered_json;

  // Both must outlive it. where: file and frame, for messages.
  TransformsFrame(const Json& file, const Json& frame, std::string where);

  const std::string& where() const { return where_; }

  [[noreturn]] void fail(const std::string& key, const std::string& got,
                         const char* expected) const;

  // Nothing where neither frame nor file has the key.
  std::optional<double> number(const char* key) const;  // finite
  std::optional<std::string> text(const char* key) const;
  bool flag(const char* key) const;  // false where there is no such key
  std::vector<double> numbers(const char* key) const;

  // 3 or 4 rows of 4 numbers.
  glm::dmat4 matrix(const char* key) const;

 private:
  const Json* find(const char* key) const;
  double finite(const std::string& key, const Json& value) const;

  const Json& file_;
  const Json& frame_;
  std::string where_;
};

// From fl_x, fl_y, or camera_angle_x, camera_angle_y; cx, cy; w, h. The lens from camera_model or
// is_fisheye, with distortion_params or k1 to k6, p1, p2. Refuses keys of cameras that are neither
// pinhole nor fisheye.
Intrinsics transforms_intrinsics(const TransformsFrame& frame);

// True for a key of a file or a frame that is read, or refused, here or by the layout.
bool is_read_of_transforms(const std::string& key);

}  // namespace sgs
