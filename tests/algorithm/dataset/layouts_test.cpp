// Each layout: the same cameras, pictures, splits and points, whatever the axes of the format.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numeric>
#include <tuple>

#include "algorithm/dataset/dataset.h"
#include "tests/algorithm/dataset/damaged_datasets.h"
#include "tests/algorithm/dataset/made_datasets.h"
#include "tests/support/scratch_folder.h"

using namespace sgs;
using namespace sgs::test;

namespace {

// The pixel where the renderers have `point` (tests/algorithm/render: the centre of the first pixel
// is 0).
glm::ivec2 pixel_of(const Camera& camera, const glm::dvec3& point) {
  const glm::dvec3 v = glm::transpose(camera.world_from_camera) * (point - camera.position);
  const glm::dvec2 middle =
      0.5 * glm::dvec2(camera.width, camera.height) - 0.5 + camera.principal_offset;
  return {static_cast<int>(std::lround(camera.focal_x * v.x / v.z + middle.x)),
          static_cast<int>(std::lround(camera.focal_y * v.y / v.z + middle.y))};
}

void check_pictures(const Dataset& dataset, const PhotographedScene& scene, double downscale,
                    double tolerance) {
  for (const DatasetView& view : dataset.views) {
    const Camera camera = downscaled_camera(view, downscale);
    const RgbaImage image = load_view(view, downscale);
    REQUIRE(image.width == camera.width);
    REQUIRE(image.height == camera.height);
    for (const MadePoint& point : scene.points) {
      const glm::ivec2 at = pixel_of(camera, point.position);
      INFO(view.name << " " << at.x << " " << at.y);
      for (int c = 0; c < 3; ++c) {
        CHECK(255 * image.at(at.x, at.y)[c] == Approx(point.colour[c]).margin(tolerance));
      }
      CHECK(image.at(at.x, at.y).w == 1.0f);
    }
  }
}

void check_cameras(const Dataset& dataset, const std::vector<MadeCamera>& expected) {
  REQUIRE(dataset.views.size() == expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const Camera& camera = dataset.views[i].camera;
    INFO(dataset.views[i].name);
    CHECK(camera.id == static_cast<int>(i));
    CHECK(camera.name == dataset.views[i].name);
    CHECK(glm::length(camera.position - expected[i].position) < 1e-9);
    CHECK(glm::length(camera.world_from_camera[0] - expected[i].right) < 1e-9);
    CHECK(glm::length(camera.world_from_camera[1] - expected[i].down) < 1e-9);
    CHECK(glm::length(camera.world_from_camera[2] - expected[i].forward) < 1e-9);
  }
}

struct Row {
  const char* layout;
  void (*write)(const std::string& folder, const PhotographedScene& scene);
  std::vector<int> test;  // numbers of the views for testing
  SplitBy split_by;
  bool has_alpha;
  double colour_tolerance;  // of 255
  std::vector<int> cameras = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
  bool states_principal_point = true;
};

const std::vector<Row>& rows() {
  constexpr double kJpeg = 60;  // colour is stored at half the resolution
  static const std::vector<Row> kRows = {
      {"COLMAP", write_colmap_binary, {0, 8}, SplitBy::kEveryEighth, false, kJpeg},
      {"COLMAP", write_colmap_text, {0, 8}, SplitBy::kEveryEighth, false, 1},
      {"NeRF synthetic",
       write_nerf_synthetic,
       {0, 1, 2},
       SplitBy::kDataset,
       true,
       0.01,
       {0, 1, 2, 3, 4, 5, 6, 7, 8, 9},
       false},
      {"transforms.json", write_transforms, {0, 8}, SplitBy::kEveryEighth, false, kJpeg},
      {"cameras.json",
       write_cameras_json,
       {0, 8},
       SplitBy::kEveryEighth,
       false,
       1,
       {0, 1, 2, 3, 4, 5, 6, 7, 8, 9},
       false},
      {"NSVF", write_nsvf_matrix, {6, 7}, SplitBy::kDataset, true, 0.01, {0, 1, 2, 3, 4, 5, 8, 9}},
      {"NSVF", write_nsvf_focal, {6, 7}, SplitBy::kDataset, true, 0.01, {0, 1, 2, 3, 4, 5, 8, 9}}};
  return kRows;
}

}  // namespace

TEST_CASE("dataset: each layout gives the cameras, pictures and split that were written") {
  const PhotographedScene scene = made_scene();
  for (const Row& row : rows()) {
    INFO(row.layout);
    const ScratchFolder scratch;
    row.write(scratch.path(""), scene);
    const Dataset dataset = open_dataset(scratch.path(""));
    CHECK(dataset.layout == row.layout);
    CHECK(dataset.split_by == row.split_by);
    CHECK(views_of(dataset, Split::kTest) == row.test);
    CHECK(views_of(dataset, Split::kTrain).size() + row.test.size() == row.cameras.size());
    CHECK(dataset.left_out == static_cast<int>(scene.cameras.size() - row.cameras.size()));
    std::vector<MadeCamera> expected;
    for (const int i : row.cameras) expected.push_back(scene.cameras[static_cast<std::size_t>(i)]);
    check_cameras(dataset, expected);
    for (const DatasetView& view : dataset.views) {
      CHECK(view.file.has_alpha == row.has_alpha);
      CHECK(view.camera.width == 64);
      CHECK(view.camera.height == 48);
      CHECK(view.camera.focal_x == Approx(60).epsilon(1e-12));
      CHECK(view.camera.focal_y == Approx(60).epsilon(1e-12));
      CHECK(view.camera.principal_offset == glm::dvec2(0));
    }
    check_pictures(dataset, scene, 1, row.colour_tolerance);
    check_pictures(dataset, scene, 2, row.colour_tolerance + 1);
    CHECK_FALSE(dataset.files.empty());
  }
}

TEST_CASE(
    "dataset: opened smaller, its cameras and pictures are, whether the sides divide or not") {
  PhotographedScene scene = made_scene();
  scene.width = 70;
  scene.height = 53;
  scene.principal = {38, 26.5};
  const ScratchFolder scratch;
  write_transforms(scratch.path(""), scene);
  const Dataset whole = open_dataset(scratch.path(""));
  for (const auto& [downscale, width, height] :
       {std::tuple(1.0, 70, 53), {2.0, 35, 27}, {1.5, 47, 35}, {4.0, 18, 13}, {1e3, 1, 1}}) {
    INFO(downscale);
    const Dataset dataset = open_dataset(scratch.path(""), {downscale, "", ""});
    REQUIRE(dataset.views.size() == whole.views.size());
    for (std::size_t i = 0; i < whole.views.size(); ++i) {
      const Camera& camera = dataset.views[i].camera;
      CHECK(camera.width == width);
      CHECK(camera.height == height);
      CHECK(camera.id == static_cast<int>(i));
      CHECK(camera.focal_x == Approx(60.0 * width / 70));
      CHECK(camera.principal_offset.x == Approx(3.0 * width / 70));
      CHECK(camera.focal_y == Approx(60.0 * height / 53));
      CHECK(camera.position == whole.views[i].camera.position);
      CHECK(dataset.views[i].split == whole.views[i].split);
      // The mean over the file's pixels, once, however it is divided between the two factors.
      CHECK(load_view(dataset.views[i]).pixels == load_view(whole.views[i], downscale).pixels);
    }
    CHECK(load_view(dataset.views[0], 2).pixels == area_averaged(load_view(whole.views[0]),
                                                                 std::max(1, (width + 1) / 2),
                                                                 std::max(1, (height + 1) / 2))
                                                       .pixels);
  }
}

TEST_CASE("dataset: start points that transforms.json names, in text and binary") {
  const std::string head = "ply\nformat ";
  const std::string properties =
      "element vertex 2\nproperty double x\nproperty float y\nproperty float z\n"
      "property float nx\nproperty uint8 red\nproperty uchar green\nproperty uint8 blue\n";
  const auto binary = [](bool turned) {
    std::string bytes;
    const auto add = [&](auto value) {
      std::string raw(reinterpret_cast<const char*>(&value), sizeof value);
      if (turned) std::reverse(raw.begin(), raw.end());
      bytes += raw;
    };
    for (const double x : {1.5, -0.25}) {
      add(x);
      for (const float value : {2.0f, -3.0f, 9.0f}) add(value);
      for (const int value : {255, 51, 0}) add(static_cast<std::uint8_t>(value));
    }
    return bytes;
  };
  const std::string text = "1.5 2 -3 9 255 51 0\n-0.25 2.0 -3e0 9 255 51 0\n";
  for (const std::string& file :
       {head + "ascii 1.0\n" + properties + "end_header\n" + text,
        head + "ascii 1.0\ncomment c\n" + properties +
            "element face 1\nproperty list uchar int v\nend_header\n" + text + "3 0 1 0\n",
        head + "binary_little_endian 1.0\n" + properties + "end_header\n" + binary(false),
        head + "binary_big_endian 1.0\n" + properties + "end_header\n" + binary(true)}) {
    const ScratchFolder scratch;
    write_transforms(scratch.path(""), made_scene());
    std::string json = bytes_of(scratch.path("transforms.json"));
    scratch.write("transforms.json", json.insert(1, R"("ply_file_path": "./pc.ply", )"));
    scratch.write("pc.ply", file);
    const Dataset dataset = open_dataset(scratch.path(""));
    REQUIRE(dataset.points.size() == 2);
    CHECK(dataset.points[0].position == glm::vec3(1.5f, 2, -3));
    CHECK(dataset.points[1].position == glm::vec3(-0.25f, 2, -3));
    for (const SfmPoint& point : dataset.points) CHECK(point.colour == glm::vec3(1, 0.2f, 0));
    CHECK(dataset.files.back() == scratch.path("pc.ply"));
  }
}

TEST_CASE("dataset: points of COLMAP, bounds of NSVF, names without extension") {
  const PhotographedScene scene = made_scene();
  for (const auto& write : {write_colmap_binary, write_colmap_text}) {
    const ScratchFolder scratch;
    write(scratch.path(""), scene);
    const Dataset dataset = open_dataset(scratch.path(""));
    REQUIRE(dataset.points.size() == scene.points.size());
    for (std::size_t i = 0; i < scene.points.size(); ++i) {
      CHECK(dataset.points[i].position == glm::vec3(scene.points[i].position));
      CHECK(dataset.points[i].colour == glm::vec3(scene.points[i].colour) / 255.0f);
    }
    CHECK_FALSE(dataset.bounds.has_value());
    CHECK(dataset.views[3].name == "shot_03");
  }
  const ScratchFolder nsvf, nerf;
  write_nsvf_matrix(nsvf.path(""), scene);
  const Dataset bounded = open_dataset(nsvf.path(""));
  REQUIRE(bounded.bounds.has_value());
  CHECK(bounded.bounds->min == glm::vec3(-1.5f, -1, -2));
  CHECK(bounded.bounds->max == glm::vec3(1.5f, 1, 2));
  CHECK(bounded.views[1].name == "0_0001");
  write_file(nsvf.path(""), "intrinsics.txt", "61 0 32\n0 59 24\n0 0 1\n");
  CHECK(open_dataset(nsvf.path("")).views[1].camera.focal_x == 61);
  CHECK(open_dataset(nsvf.path("")).views[1].camera.focal_y == 59);
  write_nerf_synthetic(nerf.path(""), scene);
  CHECK(open_dataset(nerf.path("")).views[4].name == "train/shot_04");
}

TEST_CASE("dataset: two focal lengths, and a principal point beside the middle, where it stays") {
  PhotographedScene scene = made_scene();
  scene.width = 70;
  scene.height = 53;
  for (const glm::dvec2 principal : {glm::dvec2(38, 24.5), {32.3, 29}, {35.4, 26.1}, {35, 26.5}}) {
    scene.principal = principal;
    for (const Row& row : rows()) {
      if (!row.states_principal_point) continue;
      INFO(row.layout << " " << principal.x << " " << principal.y);
      const bool one_focal = row.write == write_colmap_text || row.write == write_nsvf_focal;
      scene.focal_y = one_focal ? scene.focal_x : 54;
      const ScratchFolder scratch;
      row.write(scratch.path(""), scene);
      const Dataset dataset = open_dataset(scratch.path(""));
      for (const DatasetView& view : dataset.views) {
        CHECK(view.camera.principal_offset == principal - glm::dvec2(35, 26.5));
        CHECK(view.camera.focal_x == 60);
        CHECK(view.camera.focal_y == scene.focal_y);
        CHECK(view.camera.width == 70);
        CHECK(view.camera.height == 53);
        CHECK(view.seen == 1);
      }
      check_pictures(dataset, scene, 1, row.colour_tolerance);
    }
  }
}

TEST_CASE("dataset: images of another size than their camera's, by one factor") {
  const PhotographedScene scene = made_scene();
  for (const Row& row : rows()) {
    if (row.layout == std::string("NeRF synthetic") || row.write == write_nsvf_matrix) continue;
    INFO(row.layout);
    const ScratchFolder scratch;
    PhotographedScene stated = scene;  // thrice the images, but for what rounding lost
    row.write(scratch.path(""), scene);
    const std::filesystem::path images = scratch.path(""), kept = scratch.path("kept");
    std::filesystem::create_directory(kept);
    const char* folder = row.layout == std::string("NSVF") ? "rgb" : "images";
    std::filesystem::rename(images / folder, kept / folder);
    stated.width = 3 * 64 + 1;
    stated.height = 3 * 48 - 1;
    stated.focal_x = 3 * 60 * stated.width / 192.0;
    stated.focal_y = 3 * 60 * stated.height / 144.0;
    stated.principal = glm::dvec2(stated.width, stated.height) / 2.0;
    // Two of the formats have one focal length for both axes.
    const bool one_focal = row.write == write_colmap_text || row.write == write_nsvf_focal;
    if (one_focal) stated.focal_y = stated.focal_x;
    row.write(scratch.path(""), stated);
    std::filesystem::remove_all(images / folder);
    std::filesystem::rename(kept / folder, images / folder);
    std::filesystem::remove(kept);
    const Dataset dataset = open_dataset(scratch.path(""));
    for (const DatasetView& view : dataset.views) {
      CHECK(view.camera.width == 64);
      CHECK(view.camera.height == 48);
      CHECK(view.camera.focal_x == Approx(60).epsilon(0.02));
      CHECK(view.camera.focal_y == Approx(60).epsilon(0.02));
    }
    check_pictures(dataset, scene, 1, row.colour_tolerance);
  }
}

TEST_CASE("dataset: images may be named by their whole path") {
  const ScratchFolder scratch, elsewhere;
  write_cameras_json(scratch.path(""), made_scene());
  std::string text = bytes_of(scratch.path("cameras.json"));
  const std::string name = "shot_00";
  std::filesystem::rename(scratch.path("images/shot_00.png"), elsewhere.path("a.png"));
  scratch.write("cameras.json",
                text.replace(text.find(name), name.size(), elsewhere.path("a.png")));
  const Dataset dataset = open_dataset(scratch.path(""));
  REQUIRE(dataset.views.size() == 10);
  CHECK(dataset.views[0].image_path == elsewhere.path("a.png"));
}

TEST_CASE("dataset: images.txt without lines of points, with some of them, with comments between") {
  const PhotographedScene scene = made_scene();
  // Every other image has a line of points, the others an empty one.
  const char *kPoints = "1.5 2.5 -1\n", *kNone = "\n\n";
  const std::string file = "sparse/0/images.txt";
  for (const std::vector<Damage>& changes : std::vector<std::vector<Damage>>{
           {replace_all(file, kPoints, "")},
           {replace_all(file, kNone, "\n")},
           {replace_all(file, kPoints, ""), replace_all(file, kNone, "\n")},
           {replace_all(file, kPoints, "# none\n"), replace_all(file, kNone, "\n# none\n")},
           {replace_all(file, kPoints, "1.5 2.5 -1 nan 0 7\n")}}) {
    const ScratchFolder scratch;
    write_colmap_text(scratch.path(""), scene);
    for (const Damage& change : changes) change(scratch.path(""));
    check_cameras(open_dataset(scratch.path("")), scene.cameras);
  }
}

TEST_CASE(
    "dataset: a COLMAP model in colmap/sparse/0 and in the folder itself, beside nothing else") {
  const PhotographedScene scene = made_scene();
  for (const char* to : {"colmap/sparse/0", "."}) {
    for (const auto& write : {write_colmap_binary, write_colmap_text}) {
      INFO(to);
      const ScratchFolder scratch;
      write(scratch.path(""), scene);
      std::filesystem::create_directories(scratch.path(to));
      for (const auto& entry : std::filesystem::directory_iterator(scratch.path("sparse/0"))) {
        std::filesystem::rename(entry.path(), scratch.path(to) / entry.path().filename());
      }
      std::filesystem::remove_all(scratch.path("sparse"));
      const Dataset dataset = open_dataset(scratch.path(""));
      CHECK(dataset.layout == "COLMAP");
      CHECK(dataset.points.size() == scene.points.size());
      check_cameras(dataset, scene.cameras);
      // As nerfstudio leaves it: its own file is the data set, the model may be asked for.
      const ScratchFolder other;
      write_transforms(other.path("t"), scene);
      std::filesystem::rename(other.path("t/transforms.json"), scratch.path("transforms.json"));
      std::filesystem::copy(other.path("t/images"), scratch.path("images"),
                            std::filesystem::copy_options::skip_existing);
      const bool both_kinds = write == write_colmap_text;  // .jpg beside .png
      if (!both_kinds) CHECK(open_dataset(scratch.path("")).layout == "transforms.json");
      CHECK(open_dataset(scratch.path(""), {1, "colmap", ""}).layout == "COLMAP");
    }
  }
}

TEST_CASE("dataset: of two layouts in a folder an option chooses") {
  const ScratchFolder scratch;
  write_transforms(scratch.path(""), made_scene());
  write_cameras_json(scratch.path(""), made_scene());
  const auto open = [&](const std::string& layout) {
    return open_dataset(scratch.path(""), {1, layout, ""});
  };
  CHECK(open("transforms").layout == "transforms.json");
  std::filesystem::remove(scratch.path("images/shot_00.jpg"));
  for (int i = 0; i < 10; ++i) {
    std::filesystem::remove(scratch.path("images/shot_0" + std::to_string(i) + ".jpg"));
  }
  CHECK(open("cameras").layout == "cameras.json");
  CHECK(input_error_of([&] { open("nsvf"); })
            .find("holds no intrinsics.txt with pose and rgb, expected what --layout nsvf stands "
                  "for") != std::string::npos);
  CHECK(
      input_error_of([&] { open("blender"); }) ==
      "--layout: got 'blender', expected one of colmap, nerf-synthetic, transforms, cameras, nsvf");
}

TEST_CASE("dataset: start points in points3D.ply, where nothing else brings them") {
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
      "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
      "end_header\n1 2 3 4 5 6\n";
  struct Row {
    WriteDataset write;
    std::vector<std::string> without;
    const char* file;
    std::size_t points;
  };
  for (const Row& row :
       {Row{write_colmap_binary, {"sparse/0/points3D.bin"}, "sparse/0/points3D.ply", 1},
        Row{write_colmap_text, {"sparse/0/points3D.txt"}, "sparse/0/points3D.ply", 1},
        Row{write_colmap_text, {}, "sparse/0/points3D.ply", 5},
        Row{write_nerf_synthetic, {}, "points3d.ply", 1},
        Row{write_transforms, {}, "points3D.ply", 1}}) {
    INFO(row.file);
    const ScratchFolder scratch;
    row.write(scratch.path(""), made_scene());
    for (const std::string& file : row.without) std::filesystem::remove(scratch.path(file));
    write_file(scratch.path(""), row.file, ply);
    const Dataset dataset = open_dataset(scratch.path(""));
    REQUIRE(dataset.points.size() == row.points);
    if (row.points == 1) CHECK(dataset.points[0].position == glm::vec3(1, 2, 3));
  }
}

TEST_CASE("dataset: names that say nothing here are counted") {
  const ScratchFolder scratch;
  write_transforms(scratch.path(""), made_scene());
  replace("transforms.json", "{",
          "{\"applied_transform\": [], \"aabb_scale\": 4, ")(scratch.path(""));
  replace_all("transforms.json", "{\"file_path\"",
              "{\"sharpness\": 9, \"file_path\"")(scratch.path(""));
  const Dataset dataset = open_dataset(scratch.path(""));
  REQUIRE(dataset.notes.size() == 1);
  CHECK(dataset.notes[0].first == "not read");
  CHECK(dataset.notes[0].second == "aabb_scale, applied_transform, sharpness (10 times)");
  // An angle that a focal length stands before, where it is not the same.
  const auto note_with = [](double angle) {
    const ScratchFolder angles;
    write_transforms(angles.path(""), made_scene());
    replace("transforms.json", "{",
            fmt::format("{{\"camera_angle_x\": {}, ", angle))(angles.path(""));
    const Dataset read = open_dataset(angles.path(""));
    return read.notes.empty() ? "" : read.notes[0].second;
  };
  const Camera camera = open_dataset(scratch.path("")).views[0].camera;
  const double angle = 2 * std::atan(camera.width / 2.0 / camera.focal_x);
  CHECK(note_with(angle).empty());
  CHECK(note_with(1.1 * angle) == "camera_angle_x, since fl_x says otherwise (10 times)");
  const ScratchFolder colmap;
  write_colmap_text(colmap.path(""), made_scene());
  write_file(colmap.path(""), "masks/shot_00.png.png", "");
  REQUIRE(open_dataset(colmap.path("")).notes.size() == 1);
  CHECK(open_dataset(colmap.path("")).notes[0].second == "the folder masks");
  write_file(colmap.path(""), "sparse/1/cameras.txt", "");
  write_file(colmap.path(""), "sparse/2/notes.txt", "");
  CHECK(open_dataset(colmap.path("")).notes[0].second == "the folder masks, the model sparse/1");
}
