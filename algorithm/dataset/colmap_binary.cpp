// The little-endian form of colmap_model.h.
#include <fmt/format.h>

#include <array>
#include <cstring>
#include <filesystem>

#include "algorithm/dataset/colmap_model.h"
#include "algorithm/dataset/stated_view.h"
#include "algorithm/files/input_error.h"
#include "algorithm/files/input_file.h"

namespace sgs {
namespace {

// The models by their number in the file.
constexpr std::array<const char*, 11> kModels = {"SIMPLE_PINHOLE",
                                                 "PINHOLE",
                                                 "SIMPLE_RADIAL",
                                                 "RADIAL",
                                                 "OPENCV",
                                                 "OPENCV_FISHEYE",
                                                 "FULL_OPENCV",
                                                 "FOV",
                                                 "SIMPLE_RADIAL_FISHEYE",
                                                 "RADIAL_FISHEYE",
                                                 "THIN_PRISM_FISHEYE"};

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
  constexpr std::uint64_t kLeastBytes = 4 + 4 + 8 + 8 + 3 * 8;
  const std::uint64_t count = file.count(kLeastBytes, "cameras");
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::string where = file.entry("camera", i);
    const auto id = file.read<std::uint32_t>("a camera id");
    const auto kind = file.read<std::int32_t>("a camera model");
    const std::string name = kind >= 0 && kind < static_cast<int>(kModels.size())
                                 ? kModels[static_cast<std::size_t>(kind)]
                                 : fmt::format("number {}", kind);
    std::vector<double> parameters(static_cast<std::size_t>(colmap_parameter_count(name, where)));
    const auto width = file.read<std::uint64_t>("a width");
    const auto height = file.read<std::uint64_t>("a height");
    for (double& parameter : parameters) parameter = file.read<double>("a camera's parameters");
    add_colmap_camera(model, id, colmap_intrinsics(width, height, parameters, where), where);
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
    image.pose = colmap_pose(rotation, file.triple("a translation"), image.where);
    image.camera_id = file.read<std::uint32_t>("a camera id");
    image.name = file.name("an image's name");
    file.skip(kPoint2dBytes * file.count(kPoint2dBytes, "points of an image"));
    model.images.push_back(std::move(image));
  }
  file.expect_end();
}

void read_points(ByteReader& file, ColmapModel& model) {
  constexpr std::uint64_t kLeastBytes = 8 + 3 * 8 + 3 + 8 + 8;
  constexpr std::uint64_t kTrackBytes = 4 + 4;
  const std::uint64_t count = file.count(kLeastBytes, "points");
  model.points.reserve(count);
  for (std::uint64_t i = 0; i < count; ++i) {
    file.read<std::uint64_t>("a point id");
    const glm::dvec3 position = file.triple("a position");
    const auto red = file.read<std::uint8_t>("a colour"),
               green = file.read<std::uint8_t>("a colour"),
               blue = file.read<std::uint8_t>("a colour");
    file.read<double>("an error");
    file.skip(kTrackBytes * file.count(kTrackBytes, "images of a point"));
    model.points.push_back(sfm_point(position, {red, green, blue}, file.entry("point", i)));
  }
  file.expect_end();
}

}  // namespace

ColmapModel read_colmap_binary(const std::string& folder) {
  const auto open = [&](const char* name) {
    return ByteReader((std::filesystem::path(folder) / name).string());
  };
  ColmapModel model;
  ByteReader cameras = open("cameras.bin"), images = open("images.bin"),
             points = open("points3D.bin");
  read_cameras(cameras, model);
  read_images(images, model);
  read_points(points, model);
  return model;
}

}  // namespace sgs
