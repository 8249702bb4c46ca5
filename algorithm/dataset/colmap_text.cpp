// The text form of colmap_model.h.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "algorithm/dataset/colmap_model.h"
#include "algorithm/dataset/stated_view.h"
#include "algorithm/dataset/text_fields.h"
#include "algorithm/files/input_error.h"
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

  // Steps back to before the line that next() gave.
  void put_back(std::string_view line) {
    at_ = static_cast<std::size_t>(line.data() - text_.data());
    --number_;
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
    ColmapCamera camera;
    camera.where = lines.where();
    TextFields fields(line, camera.where);
    const auto id = static_cast<std::uint32_t>(fields.whole_number("a camera id", kMostId));
    camera.model = fields.word("a camera model");
    camera.width = fields.whole_number("a width", INT32_MAX);
    camera.height = fields.whole_number("a height", INT32_MAX);
    if (const auto count = colmap_parameter_count(camera.model)) {
      for (int left = *count; left > 0; --left) {
        camera.parameters.push_back(fields.number("a camera's parameter"));
      }
      fields.expect_end();
    }
    add_colmap_camera(model, id, std::move(camera));
  }
}

ColmapImage read_image(std::string_view line, const std::string& where) {
  ColmapImage image;
  image.where = where;
  TextFields fields(line, where);
  fields.whole_number("an image id", kMostId);
  double numbers[7];
  for (double& number : numbers) number = fields.number("a pose");
  glm::dquat rotation;
  rotation.w = numbers[0];
  rotation.x = numbers[1];
  rotation.y = numbers[2];
  rotation.z = numbers[3];
  image.pose = colmap_pose(rotation, {numbers[4], numbers[5], numbers[6]}, where + ": pose");
  image.camera_id = static_cast<std::uint32_t>(fields.whole_number("a camera id", kMostId));
  image.name = fields.rest("an image's name");
  return image;
}

bool is_comment(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \t");
  return first != std::string_view::npos && line[first] == '#';
}

// What the line behind an image is, by its fields.
enum class BehindImage { kPoints, kImage, kNeither };

// Points are x, y and the number of a point each; an image has ten fields or more.
BehindImage kind_of(std::string_view line, int& count) {
  constexpr int kFieldsOfImage = 10;
  TextFields fields(line, "");
  bool numbers = true;
  for (count = 0; !fields.at_end(); ++count) numbers &= is_number(fields.word(""));
  if (numbers && count % 3 == 0) return BehindImage::kPoints;
  return count >= kFieldsOfImage ? BehindImage::kImage : BehindImage::kNeither;
}

// The points of an image in its picture, on the line behind it; other programs leave it out.
void pass_points(Lines& lines) {
  std::string_view line;
  if (!lines.next(line)) return;
  if (is_comment(line)) return lines.put_back(line);
  int count = 0;
  switch (kind_of(line, count)) {
    case BehindImage::kPoints:
      return;
    case BehindImage::kImage:
      return lines.put_back(line);
    default:
      throw InputError(fmt::format(
          "{}: got {} fields, expected the points of the image before it, 3 numbers each, or "
          "another image",
          lines.where(), count));
  }
}

void read_images(Lines& lines, ColmapModel& model) {
  for (std::string_view line; lines.next_record(line);) {
    model.images.push_back(read_image(line, lines.where()));
    pass_points(lines);
  }
}

// An error, and image and point for each place where the point is seen; both may be left out.
void pass_track(TextFields& fields) {
  if (fields.at_end()) return;
  fields.any_number("an error");
  while (!fields.at_end()) {
    fields.whole_number("an image id of a track", UINT64_MAX);
    fields.whole_number("a point's number of a track", UINT64_MAX);
  }
}

std::vector<SfmPoint> read_points(Lines& lines) {
  std::vector<SfmPoint> points;
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
    pass_track(fields);
    points.push_back(sfm_point(position, colour, where));
  }
  return points;
}

Lines text_of(const std::string& folder, const char* name) {
  return Lines((std::filesystem::path(folder) / name).string());
}

}  // namespace

ColmapModel read_colmap_text(const std::string& folder) {
  ColmapModel model;
  Lines cameras = text_of(folder, "cameras.txt"), images = text_of(folder, "images.txt");
  read_cameras(cameras, model);
  read_images(images, model);
  return model;
}

std::vector<SfmPoint> read_colmap_points_text(const std::string& folder) {
  Lines points = text_of(folder, "points3D.txt");
  return read_points(points);
}

}  // namespace sgs
