// The layouts of made_datasets.h.
#include "tests/algorithm/dataset/made_datasets.h"

#include <fmt/format.h>
#include <png.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>

#include "algorithm/image/image_formats.h"
#include "tests/algorithm/image/jpeg_bytes.h"

namespace sgs::test {
namespace {

namespace fs = std::filesystem;

template <class Value>
void append(std::string& bytes, Value value) {
  char raw[sizeof(Value)];
  std::memcpy(raw, &value, sizeof(Value));
  bytes.append(raw, sizeof(Value));
}

void append(std::string& bytes, const glm::dvec3& v) {
  for (int i = 0; i < 3; ++i) append(bytes, v[i]);
}

// x_camera = R x_world + t, R's rows the axes; its quaternion by the trace, which is above -0.9 for
// the cameras here.
struct ColmapPose {
  double w, x, y, z;
  glm::dvec3 t;
};

ColmapPose colmap_pose_of(const MadeCamera& c) {
  const double w = 0.5 * std::sqrt(1 + c.right.x + c.down.y + c.forward.z);
  return {w,
          (c.forward.y - c.down.z) / (4 * w),
          (c.right.z - c.forward.x) / (4 * w),
          (c.down.x - c.right.y) / (4 * w),
          {-glm::dot(c.right, c.position), -glm::dot(c.down, c.position),
           -glm::dot(c.forward, c.position)}};
}

std::string image_name(std::size_t i) { return fmt::format("shot_{:02}", i); }

// The rows of a matrix whose columns are x, y, z and the position; between and around them.
std::string matrix(const MadeCamera& c, double y_sign, double z_sign, const char* open,
                   const char* comma, const char* close) {
  std::string rows;
  for (int row = 0; row < 3; ++row) {
    rows += fmt::format("{}{}{}{}{}{}{}{}{}{}", open, c.right[row], comma, y_sign * c.down[row],
                        comma, z_sign * c.forward[row], comma, c.position[row], close,
                        *comma == ',' ? "," : "\n");
  }
  return rows + fmt::format("{}0{}0{}0{}1{}", open, comma, comma, comma, close);
}

std::string opengl_frame(const MadeCamera& camera, const std::string& file) {
  return fmt::format(R"({{"file_path": "{}", "transform_matrix": [{}]}})", file,
                     matrix(camera, -1, -1, "[", ",", "]"));
}

void write_nsvf(const std::string& folder, const PhotographedScene& scene) {
  for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
    // 0..5 train, 6 and 7 validation, 8 and 9 test.
    const std::string name = fmt::format("{}_{:04}", i < 6 ? 0 : i < 8 ? 1 : 2, i);
    write_file(folder, "rgb/" + name + ".png", rgba_png(picture_of(scene, scene.cameras[i])));
    write_file(folder, "pose/" + name + ".txt", matrix(scene.cameras[i], 1, 1, "", " ", "") + "\n");
  }
  write_file(folder, "bbox.txt", "-1.5 -1 -2 1.5 1 2 0.4\n");
}

}  // namespace

PhotographedScene made_scene() {
  PhotographedScene scene;
  for (int i = 0; i < 10; ++i) {
    // Forward about world x, right about world y, down about world z.
    MadeCamera camera;
    camera.position = {-5 + 0.05 * i, 0.3 * i - 1.2, 0.5 * std::sin(1.0 + i)};
    camera.forward = glm::normalize(glm::dvec3(0.1, 0.05, -0.1) - camera.position);
    camera.right = glm::normalize(glm::cross(glm::dvec3(0, 0.1 * i - 0.3, 1), camera.forward));
    camera.down = glm::cross(camera.forward, camera.right);
    scene.cameras.push_back(camera);
  }
  scene.points = {{{0, 0, 0}, {250, 20, 30}},
                  {{0.2, 1.1, 0.4}, {20, 240, 40}},
                  {{-0.3, -1.0, 0.7}, {30, 60, 250}},
                  {{0.1, 0.6, -0.9}, {240, 230, 20}},
                  {{0.4, -0.8, -0.8}, {230, 30, 240}}};
  return scene;
}

glm::dvec2 projected(const PhotographedScene& scene, const MadeCamera& camera,
                     const glm::dvec3& point) {
  const glm::dvec3 away = point - camera.position;
  const double depth = glm::dot(camera.forward, away);
  return {scene.principal.x + scene.focal_x * glm::dot(camera.right, away) / depth,
          scene.principal.y + scene.focal_y * glm::dot(camera.down, away) / depth};
}

RgbaImage picture_of(const PhotographedScene& scene, const MadeCamera& camera) {
  constexpr double kRadiusPx = 3;
  RgbaImage image(scene.width, scene.height);
  for (const MadePoint& point : scene.points) {
    const glm::dvec2 centre = projected(scene, camera, point.position);
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        if (glm::length(glm::dvec2(x + 0.5, y + 0.5) - centre) <= kRadiusPx) {
          image.at(x, y) = glm::vec4(glm::vec3(point.colour) / 255.0f, 1);
        }
      }
    }
  }
  return image;
}

std::string rgba_png(const RgbaImage& image) {
  std::vector<std::uint8_t> samples;
  for (const glm::vec4& pixel : image.pixels) {
    for (int i = 0; i < 4; ++i) {
      samples.push_back(static_cast<std::uint8_t>(std::lround(255 * pixel[i])));
    }
  }
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = PNG_FORMAT_RGBA;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
  std::string bytes(size, '\0');
  png_image_write_to_memory(&png, bytes.data(), &size, 0, samples.data(), 0, nullptr);
  bytes.resize(size);
  return bytes;
}

std::string grey_before_png(const RgbaImage& image) {
  return encode_png(over(image, glm::vec3(0.4f)));
}

std::string grey_before_jpeg(const RgbaImage& image) {
  std::vector<std::uint8_t> samples;
  for (const glm::vec3& pixel : over(image, glm::vec3(0.4f)).pixels) {
    for (int i = 0; i < 3; ++i) {
      samples.push_back(static_cast<std::uint8_t>(std::lround(255 * pixel[i])));
    }
  }
  return jpeg_bytes(image.width, image.height, 3, samples);
}

void write_file(const std::string& folder, const std::string& name, const std::string& bytes) {
  const fs::path path = fs::path(folder) / name;
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << bytes;
}

void write_colmap_binary(const std::string& folder, const PhotographedScene& scene) {
  std::string cameras, images, points;
  append(cameras, std::uint64_t{1});
  append(cameras, std::uint32_t{7});
  append(cameras, std::int32_t{1});  // PINHOLE
  append(cameras, static_cast<std::uint64_t>(scene.width));
  append(cameras, static_cast<std::uint64_t>(scene.height));
  for (const double parameter :
       {scene.focal_x, scene.focal_y, scene.principal.x, scene.principal.y}) {
    append(cameras, parameter);
  }
  append(images, static_cast<std::uint64_t>(scene.cameras.size()));
  for (std::size_t i = scene.cameras.size(); i-- > 0;) {  // not in the order of names
    const ColmapPose pose = colmap_pose_of(scene.cameras[i]);
    append(images, static_cast<std::uint32_t>(i + 1));
    for (const double number : {pose.w, pose.x, pose.y, pose.z}) append(images, number);
    append(images, pose.t);
    append(images, std::uint32_t{7});
    images += image_name(i) + ".jpg" + '\0';
    append(images, std::uint64_t{2});
    for (int j = 0; j < 2; ++j) {
      append(images, 1.0);
      append(images, 2.0);
      append(images, std::int64_t{-1});
    }
    write_file(folder, "images/" + image_name(i) + ".jpg",
               grey_before_jpeg(picture_of(scene, scene.cameras[i])));
  }
  append(points, static_cast<std::uint64_t>(scene.points.size()));
  for (std::size_t i = 0; i < scene.points.size(); ++i) {
    append(points, static_cast<std::uint64_t>(i + 1));
    append(points, scene.points[i].position);
    for (int c = 0; c < 3; ++c) append(points, scene.points[i].colour[c]);
    append(points, 0.5);
    append(points, std::uint64_t{1});
    append(points, std::uint32_t{1});
    append(points, std::uint32_t{0});
  }
  write_file(folder, "sparse/0/cameras.bin", cameras);
  write_file(folder, "sparse/0/images.bin", images);
  write_file(folder, "sparse/0/points3D.bin", points);
}

void write_colmap_text(const std::string& folder, const PhotographedScene& scene) {
  std::string images = "# IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME\n";
  for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
    const ColmapPose p = colmap_pose_of(scene.cameras[i]);
    // Every other image has no points, and so an empty line.
    images += fmt::format("{} {} {} {} {} {} {} {} 3 {}.png\n{}\n", i + 1, p.w, p.x, p.y, p.z,
                          p.t.x, p.t.y, p.t.z, image_name(i), i % 2 == 0 ? "1.5 2.5 -1" : "");
    write_file(folder, "images/" + image_name(i) + ".png",
               grey_before_png(picture_of(scene, scene.cameras[i])));
  }
  std::string points = "# POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[]\n";
  for (const MadePoint& p : scene.points) {
    points += fmt::format("9 {} {} {} {} {} {} 0.25 1 0\n", p.position.x, p.position.y,
                          p.position.z, p.colour.x, p.colour.y, p.colour.z);
  }
  write_file(folder, "sparse/0/cameras.txt",
             fmt::format("# Camera list\n3 SIMPLE_PINHOLE {} {} {} {} {}\n", scene.width,
                         scene.height, scene.focal_x, scene.principal.x, scene.principal.y));
  write_file(folder, "sparse/0/images.txt", images);
  write_file(folder, "sparse/0/points3D.txt", points);
}

void write_nerf_synthetic(const std::string& folder, const PhotographedScene& scene) {
  const double angle = 2 * std::atan(0.5 * scene.width / scene.focal_x);
  std::string frames[2];
  for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
    const bool test = i < 3;  // "test/" comes before "train/"
    const std::string name = (test ? "test/" : "train/") + image_name(i);
    std::string& list = frames[test ? 1 : 0];
    list += (list.empty() ? "" : ",\n") + opengl_frame(scene.cameras[i], "./" + name);
    write_file(folder, name + ".png", rgba_png(picture_of(scene, scene.cameras[i])));
  }
  for (const bool test : {false, true}) {
    write_file(
        folder, test ? "transforms_test.json" : "transforms_train.json",
        fmt::format(R"({{"camera_angle_x": {}, "frames": [{}]}})", angle, frames[test ? 1 : 0]));
  }
}

void write_transforms(const std::string& folder, const PhotographedScene& scene) {
  std::string frames;
  for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
    const std::string name = "images/" + image_name(i) + ".jpg";
    frames += (i == 0 ? "" : ",\n") + opengl_frame(scene.cameras[i], name);
    write_file(folder, name, grey_before_jpeg(picture_of(scene, scene.cameras[i])));
  }
  write_file(folder, "transforms.json",
             fmt::format(R"({{"camera_model": "OPENCV", "fl_x": {}, "fl_y": {}, "cx": {}, "cy": {},
 "w": {}, "h": {}, "k1": 0.0, "p1": 0, "frames": [{}]}})",
                         scene.focal_x, scene.focal_y, scene.principal.x, scene.principal.y,
                         scene.width, scene.height, frames));
}

void write_cameras_json(const std::string& folder, const PhotographedScene& scene) {
  std::string list;
  for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
    const MadeCamera& c = scene.cameras[i];
    std::string rows;
    for (int row = 0; row < 3; ++row) {
      rows += fmt::format("{}[{}, {}, {}]", row == 0 ? "" : ", ", c.right[row], c.down[row],
                          c.forward[row]);
    }
    list +=
        fmt::format(R"({}{{"id": {}, "img_name": "{}", "width": {}, "height": {},
 "position": [{}, {}, {}], "rotation": [{}], "fx": {}, "fy": {}}})",
                    i == 0 ? "" : ",\n", i, image_name(i), scene.width, scene.height, c.position.x,
                    c.position.y, c.position.z, rows, scene.focal_x, scene.focal_y);
    write_file(folder, "images/" + image_name(i) + ".png", grey_before_png(picture_of(scene, c)));
  }
  write_file(folder, "cameras.json", "[" + list + "]");
}

void write_nsvf_matrix(const std::string& folder, const PhotographedScene& scene) {
  write_nsvf(folder, scene);
  write_file(folder, "intrinsics.txt",
             fmt::format("{} 0 {} 0\n0 {} {} 0\n0 0 1 0\n0 0 0 1\n", scene.focal_x,
                         scene.principal.x, scene.focal_y, scene.principal.y));
}

void write_nsvf_focal(const std::string& folder, const PhotographedScene& scene) {
  write_nsvf(folder, scene);
  write_file(folder, "intrinsics.txt",
             fmt::format("{} {} {} 0.\n0. 0. 0.\n0.\n1.\n{} {}\n", scene.focal_x, scene.principal.x,
                         scene.principal.y, scene.height, scene.width));
}

}  // namespace sgs::test
