// The text form of colmap_model.h.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "algorithm/dataset/colmap_model.h"
#include "algorithm/dataset/stated_view.h"
#include "algorithm/dataset/text_fields.h"
#include "algorithm/files/input_file.h"

namespace sgs {
namespace {

constexpr std::uint64_t kMostId = UINT32_MAX;

// Lines of any length: images.txt has all points of an image in one.
class Lines {
 public:
  explicit Lines(const std::string& path) : path_(path) {
    const InputFile file(path);
    text_ = file.text_from(0, file.size_bytes());
  }

  // The next line; false at the end.
  bool next(std::string_view& line) {
    if (at_ >= text_.size()) return false;
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    line = std::string_view(text_).substr(at_, end - at_);
    at_ = end + 1;
    ++number_;
    return true;
  }

  // The next line that is neither empty nor a comment.
  bool next_record(std::string_view& line) {
    while (next(line)) {
      const std::size_t first = line.find_first_not_of(" \t\r");
      if (first != std::string_view::npos && line[first] != '#') return true;
    }
    return false;
  }

  std::string where() const { return fmt::format("{}: line {}", path_, number_); }

 private:
  std::string path_;
  std::string text_;
  std::size_t at_ = 0;
  std::uint64_t number_ = 0;
};

void read_cameras(Lines& lines, ColmapModel& model) {
  for (std::string_view line; lines.next_record(line);) {
    const std::string where = lines.where();
    TextFields fields(line, where);
    const auto id = static_cast<std::uint32_t>(fields.whole_number("a camera id", kMostId));
    std::vector<double> parameters(
        static_cast<std::size_t>(colmap_parameter_count(fields.word("a camera model"), where)));
    const std::uint64_t width = fields.whole_number("a width", INT32_MAX);
    const std::uint64_t height = fields.whole_number("a height", INT32_MAX);
    for (double& parameter : parameters) parameter = fields.number("a camera's parameter");
    fields.expect_end();
    add_colmap_camera(model, id, colmap_intrinsics(width, height, parameters, where), where);
  }
}

void read_images(Lines& lines, ColmapModel& model) {
  for (std::string_view line; lines.next_record(line);) {
    ColmapImage image;
    image.where = lines.where();
    TextFields fields(line, image.where);
    fields.whole_number("an image id", kMostId);
    double numbers[7];
    for (double& number : numbers) number = fields.number("a pose");
    glm::dquat rotation;
    rotation.w = numbers[0];
    rotation.x = numbers[1];
    rotation.y = numbers[2];
    rotation.z = numbers[3];
    image.pose = colmap_pose(rotation, {numbers[4], numbers[5], numbers[6]}, image.where);
    image.camera_id = static_cast<std::uint32_t>(fields.whole_number("a camera id", kMostId));
    image.name = fields.rest("an image's name");
    model.images.push_back(std::move(image));
    lines.next(line);  // its points in the picture; an empty line where there are none
  }
}

void read_points(Lines& lines, ColmapModel& model) {
  for (std::string_view line; lines.next_record(line);) {
    const std::string where = lines.where();
    TextFields fields(line, where);
    fields.whole_number("a point id", UINT64_MAX);
    glm::dvec3 position(0.0);
    for (int axis = 0; axis < 3; ++axis) position[axis] = fields.number("a position");
    glm::u8vec3 colour(0);
    for (int i = 0; i < 3; ++i) {
      colour[i] = static_cast<std::uint8_t>(fields.whole_number("a colour", 255));
    }
    model.points.push_back(sfm_point(position, colour, where));
  }
}

}  // namespace

ColmapModel read_colmap_text(const std::string& folder) {
  const auto open = [&](const char* name) {
    return Lines((std::filesystem::path(folder) / name).string());
  };
  ColmapModel model;
  Lines cameras = open("cameras.txt"), images = open("images.txt"), points = open("points3D.txt");
  read_cameras(cameras, model);
  read_images(images, model);
  read_points(points, model);
  return model;
}

}  // namespace sgs
