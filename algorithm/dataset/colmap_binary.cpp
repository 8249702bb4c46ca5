// The little-endian form of colmap_model.h.
#include <fmt/format.h>

#include <cstring>
#include <filesystem>

#include "algorithm/dataset/colmap_model.h"
#include "algorithm/dataset/stated_view.h"
#include "algorithm/files/input_error.h"
#include "algorithm/files/input_file.h"

namespace sgs {
namespace {

// The bytes of a file from front to back.
class ByteReader {
 public:
  explicit ByteReader(const std::string& path) : path_(path) {
    const InputFile file(path);
    bytes_ = file.text_from(0, file.size_bytes());
  }

  const std::string& path() const { return path_; }
  std::string entry(const char* kind, std::uint64_t index) const {
    return fmt::format("{}: {} {}", path_, kind, index);
  }

  template <class Value>
  Value read(const char* what) {
    Value value;
    need(sizeof(Value), what);
    std::memcpy(&value, bytes_.data() + at_, sizeof(Value));
    at_ += sizeof(Value);
    return value;
  }

  glm::dvec3 triple(const char* what) {
    const auto x = read<double>(what), y = read<double>(what), z = read<double>(what);
    return {x, y, z};
  }

  // Up to its end of text, a byte 0.
  std::string name(const char* what) {
    const std::size_t end = bytes_.find('\0', at_);
    if (end == std::string::npos) need(bytes_.size() - at_ + 1, what);
    std::string text = bytes_.substr(at_, end - at_);
    at_ = end + 1;
    return text;
  }

  // A number of records of `least_bytes` or more that are still to come.
  std::uint64_t count(std::uint64_t least_bytes, const char* what) {
    const auto number = read<std::uint64_t>(what);
    if (number > (bytes_.size() - at_) / least_bytes) {
      throw InputError(fmt::format("{}: byte {}: got {} {}, expected as many as {} more bytes hold",
                                   path_, at_ - sizeof(number), number, what, bytes_.size() - at_));
    }
    return number;
  }

  // bytes: so many that are there, as count() has found.
  void skip(std::uint64_t bytes) { at_ += bytes; }

  void expect_end() const {
    if (at_ == bytes_.size()) return;
    throw InputError(
        fmt::format("{}: byte {}: got {} bytes after the last record, expected the end of the file",
                    path_, at_, bytes_.size() - at_));
  }

 private:
  void need(std::size_t size, const char* what) const {
    if (size <= bytes_.size() - at_) return;
    throw InputError(
        fmt::format("{}: byte {}: the file ends, expected {}", path_, bytes_.size(), what));
  }

  std::string path_;
  std::string bytes_;
  std::size_t at_ = 0;
};

void read_cameras(ByteReader& file, ColmapModel& model) {
  constexpr std::uint64_t kLeastBytes = 4 + 4 + 8 + 8 + 2 * 8;
  const std::uint64_t count = file.count(kLeastBytes, "cameras");
  for (std::uint64_t i = 0; i < count; ++i) {
    ColmapCamera camera;
    camera.where = file.entry("camera", i);
    const auto id = file.read<std::uint32_t>("a camera id");
    camera.model = colmap_model_name(file.read<std::int32_t>("a camera model"), camera.where);
    camera.width = file.read<std::uint64_t>("a width");
    camera.height = file.read<std::uint64_t>("a height");
    for (int left = *colmap_parameter_count(camera.model); left > 0; --left) {
      camera.parameters.push_back(file.read<double>("a camera's parameters"));
    }
    add_colmap_camera(model, id, std::move(camera));
  }
  file.expect_end();
}

void read_images(ByteReader& file, ColmapModel& model) {
  constexpr std::uint64_t kLeastBytes = 4 + 7 * 8 + 4 + 1 + 8;
  constexpr std::uint64_t kPoint2dBytes = 8 + 8 + 8;
  const std::uint64_t count = file.count(kLeastBytes, "images");
  for (std::uint64_t i = 0; i < count; ++i) {
    ColmapImage image;
    image.where = file.entry("image", i);
    file.read<std::uint32_t>("an image id");
    glm::dquat rotation;
    rotation.w = file.read<double>("a quaternion");
    const glm::dvec3 axis = file.triple("a quaternion");
    rotation.x = axis.x;
    rotation.y = axis.y;
    rotation.z = axis.z;
    image.pose = colmap_pose(rotation, file.triple("a translation"), image.where + ": pose");
    image.camera_id = file.read<std::uint32_t>("a camera id");
    image.name = file.name("an image's name");
    file.skip(kPoint2dBytes * file.count(kPoint2dBytes, "points of an image"));
    model.images.push_back(std::move(image));
  }
  file.expect_end();
}

std::vector<SfmPoint> read_points(ByteReader& file) {
  constexpr std::uint64_t kLeastBytes = 8 + 3 * 8 + 3 + 8 + 8;
  constexpr std::uint64_t kTrackBytes = 4 + 4;
  const std::uint64_t count = file.count(kLeastBytes, "points");
  std::vector<SfmPoint> points;
  points.reserve(count);
  for (std::uint64_t i = 0; i < count; ++i) {
    file.read<std::uint64_t>("a point id");
    const glm::dvec3 position = file.triple("a position");
    const auto red = file.read<std::uint8_t>("a colour"),
               green = file.read<std::uint8_t>("a colour"),
               blue = file.read<std::uint8_t>("a colour");
    file.read<double>("an error");
    file.skip(kTrackBytes * file.count(kTrackBytes, "images of a point"));
    points.push_back(sfm_point(position, {red, green, blue}, file.entry("point", i)));
  }
  file.expect_end();
  return points;
}

ByteReader bytes_of(const std::string& folder, const char* name) {
  return ByteReader((std::filesystem::path(folder) / name).string());
}

}  // namespace

ColmapModel read_colmap_binary(const std::string& folder) {
  ColmapModel model;
  ByteReader cameras = bytes_of(folder, "cameras.bin"), images = bytes_of(folder, "images.bin");
  read_cameras(cameras, model);
  read_images(images, model);
  return model;
}

std::vector<SfmPoint> read_colmap_points_binary(const std::string& folder) {
  ByteReader points = bytes_of(folder, "points3D.bin");
  return read_points(points);
}

}  // namespace sgs
