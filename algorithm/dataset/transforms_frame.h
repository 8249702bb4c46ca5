// One frame of transforms.json, and its camera.
#pragma once

#include <glm/mat4x4.hpp>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

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

  // 3 or 4 rows of 4 numbers.
  glm::dmat4 matrix(const char* key) const;

 private:
  const Json* find(const char* key) const;
  double finite(const std::string& key, const Json& value) const;

  const Json& file_;
  const Json& frame_;
  std::string where_;
};

// From fl_x, fl_y, or camera_angle_x, camera_angle_y; cx, cy; w, h, or the size of `image`. Refuses
// distortion and models of cameras that are no pinhole.
Intrinsics transforms_intrinsics(const TransformsFrame& frame, const ImageHeader& image);

}  // namespace sgs
