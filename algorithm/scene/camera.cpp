// The JSON form of cameras, resizing, and the way between two of them.
#include "algorithm/scene/camera.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <nlohmann/json.hpp>

#include "algorithm/files/input_error.h"
#include "algorithm/files/input_json.h"
#include "algorithm/files/output_file.h"
#include "algorithm/scene/gaussian_cloud.h"

namespace sgs {

Camera camera_between(const Camera& a, const Camera& b, double t) {
  Camera camera = a;
  // Ends are the poses as given: a quaternion and back rounds.
  if (t == 0) return camera;
  if (t == 1) {
    camera.position = b.position;
    camera.world_from_camera = b.world_from_camera;
    return camera;
  }
  camera.position = (1 - t) * a.position + t * b.position;
  camera.world_from_camera = glm::mat3_cast(
      glm::slerp(glm::quat_cast(a.world_from_camera), glm::quat_cast(b.world_from_camera), t));
  return camera;
}

namespace {

using Json = nlohmann::ordered_json;

constexpr double kOrthonormalTolerance = 1e-3;

// Values of one entry of the array; errors name file, entry and key.
class EntryReader {
 public:
  EntryReader(const std::string& path, std::size_t index, const Json& entry)
      : path_(path), index_(index), entry_(entry) {
    if (!entry.is_object()) {
      throw InputError(
          fmt::format("{}: camera {}: got {}, expected an object", path, index, entry.type_name()));
    }
  }

  [[noreturn]] void fail(const std::string& key, const std::string& got,
                         const std::string& expected) const {
    throw InputError(
        fmt::format("{}: camera {}: {}: got {}, expected {}", path_, index_, key, got, expected));
  }

  const Json& at(const char* key, const char* expected) const {
    const auto found = entry_.find(key);
    if (found == entry_.end()) fail(key, "nothing", expected);
    return *found;
  }

  int integer(const char* key, int least, const char* expected) const {
    const Json& value = at(key, expected);
    // 640.0 is written by programs that know floats only.
    const double number = value.is_number() ? value.get<double>() : NAN;
    if (!(number >= least && number <= 2147483647.0) || number != std::floor(number)) {
      fail(key, shown(value), expected);
    }
    return static_cast<int>(number);
  }

  double number(const std::string& key, const Json& value) const {
    if (!value.is_number() || !std::isfinite(value.get<double>())) {
      fail(key, shown(value), "a finite number");
    }
    return value.get<double>();
  }

  double focal(const char* key) const {
    const double focal_px = number(key, at(key, "a focal length in px above 0"));
    if (focal_px <= 0) fail(key, fmt::format("{}", focal_px), "a focal length in px above 0");
    if (focal_px > kMaxFocalPx) {
      fail(key, fmt::format("{}", focal_px), fmt::format("at most {} px", kMaxFocalPx));
    }
    return focal_px;
  }

  glm::dvec3 position(const char* key) const {
    const glm::dvec3 at = triple(key, this->at(key, "an array of 3 numbers"));
    for (int i = 0; i < 3; ++i) {
      if (std::abs(at[i]) <= kMaxCoordinate) continue;
      fail(fmt::format("{}[{}]", key, i), fmt::format("{}", at[i]),
           fmt::format("a magnitude of at most {}", kMaxCoordinate));
    }
    return at;
  }

  glm::dvec3 triple(const std::string& key, const Json& value) const {
    if (!value.is_array() || value.size() != 3) fail(key, shown(value), "an array of 3 numbers");
    glm::dvec3 out(0.0);
    for (int i = 0; i < 3; ++i) out[i] = number(fmt::format("{}[{}]", key, i), value[i]);
    return out;
  }

  // In a picture of `size_px`: minus its middle. 0 where the key is not there.
  double principal_offset(const char* key, int size_px) const {
    const auto found = entry_.find(key);
    if (found == entry_.end()) return 0;
    const double at_px = number(key, *found);
    if (!(at_px >= 0 && at_px <= size_px)) {
      fail(key, fmt::format("{}", at_px), fmt::format("px from 0 to {}, in the picture", size_px));
    }
    return at_px - 0.5 * size_px;
  }

  // Rows as stored; glm::dmat3 is made of columns.
  glm::dmat3 rotation(const char* key) const {
    const Json& value = at(key, "3 rows of 3 numbers");
    if (!value.is_array() || value.size() != 3) fail(key, shown(value), "3 rows of 3 numbers");
    glm::dmat3 rows(1.0);
    for (int row = 0; row < 3; ++row) {
      rows[row] = triple(fmt::format("{}[{}]", key, row), value[row]);
    }
    const glm::dmat3 gram = rows * glm::transpose(rows);
    double worst = 0;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) worst = std::max(worst, std::abs(gram[i][j] - (i == j ? 1 : 0)));
    }
    if (!(worst <= kOrthonormalTolerance)) {
      fail(key, fmt::format("axes that are off by {:.3g}", worst),
           "columns orthonormal within 1e-3");
    }
    if (glm::determinant(rows) < 0) fail(key, "a mirrored frame", "determinant +1");
    return glm::transpose(rows);
  }

 private:
  const std::string& path_;
  std::size_t index_;
  const Json& entry_;
};

Camera read_camera(const std::string& path, std::size_t index, const Json& entry) {
  const EntryReader reader(path, index, entry);
  Camera camera;
  camera.id = reader.integer("id", -2147483647, "a whole number");
  const Json& name = reader.at("img_name", "a text");
  if (!name.is_string()) reader.fail("img_name", shown(name), "a text");
  camera.name = name.get<std::string>();
  camera.width = reader.integer("width", 1, "a whole number of px from 1");
  camera.height = reader.integer("height", 1, "a whole number of px from 1");
  camera.focal_x = reader.focal("fx");
  camera.focal_y = reader.focal("fy");
  camera.position = reader.position("position");
  camera.world_from_camera = reader.rotation("rotation");
  camera.principal_offset = {reader.principal_offset("cx", camera.width),
                             reader.principal_offset("cy", camera.height)};
  return camera;
}

}  // namespace

std::vector<Camera> cameras_of(const Json& array, const std::string& origin) {
  if (!array.is_array()) {
    throw InputError(
        fmt::format("{}: got {}, expected an array of cameras", origin, array.type_name()));
  }
  std::vector<Camera> cameras;
  for (std::size_t i = 0; i < array.size(); ++i) {
    cameras.push_back(read_camera(origin, i, array[i]));
  }
  return cameras;
}

std::vector<Camera> read_cameras(const std::string& path) {
  return cameras_of(read_json(path), path);
}

void write_cameras(const std::string& path, const std::vector<Camera>& cameras) {
  Json json = Json::array();
  for (const Camera& camera : cameras) {
    const glm::dmat3 rows = glm::transpose(camera.world_from_camera);
    Json rotation = Json::array();
    for (int row = 0; row < 3; ++row) rotation.push_back({rows[row].x, rows[row].y, rows[row].z});
    json.push_back({{"id", camera.id},
                    {"img_name", camera.name},
                    {"width", camera.width},
                    {"height", camera.height},
                    {"position", {camera.position.x, camera.position.y, camera.position.z}},
                    {"rotation", rotation},
                    {"fy", camera.focal_y},
                    {"fx", camera.focal_x}});
    if (camera.principal_offset == glm::dvec2(0)) continue;
    json.back()["cx"] = 0.5 * camera.width + camera.principal_offset.x;
    json.back()["cy"] = 0.5 * camera.height + camera.principal_offset.y;
  }
  const std::string text = json.dump(1) + "\n";
  write_whole_file(path, text.data(), text.size());
}

Camera scaled_to(const Camera& camera, int width, int height) {
  if (width < 1 || height < 1 || camera.width < 1 || camera.height < 1) {
    throw InputError(fmt::format("camera {} of {}x{} scaled to {}x{}: expected sizes from 1 px",
                                 camera.id, camera.width, camera.height, width, height));
  }
  Camera scaled = camera;
  scaled.width = width;
  scaled.height = height;
  scaled.focal_x = camera.focal_x * width / camera.width;
  scaled.focal_y = camera.focal_y * height / camera.height;
  scaled.principal_offset = {camera.principal_offset.x * width / camera.width,
                             camera.principal_offset.y * height / camera.height};
  return scaled;
}

}  // namespace sgs
