// Cameras to draw from: of every file and folder the same.
#include "algorithm/dataset/view_cameras.h"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>

#include "algorithm/dataset/dataset.h"
#include "tests/algorithm/dataset/damaged_datasets.h"
#include "tests/algorithm/dataset/made_datasets.h"
#include "tests/support/scratch_folder.h"

using namespace sgs;
using namespace sgs::test;
using Catch::Matchers::Contains;

namespace {

void check_made(const ViewCameras& read, const PhotographedScene& scene,
                const std::vector<std::size_t>& which = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}) {
  REQUIRE(read.cameras.size() == which.size());
  for (std::size_t i = 0; i < which.size(); ++i) {
    const Camera& camera = read.cameras[i];
    const MadeCamera& made = scene.cameras[which[i]];
    INFO(camera.name);
    CHECK(camera.id == static_cast<int>(i));
    CHECK(camera.width == scene.width);
    CHECK(camera.height == scene.height);
    CHECK(camera.focal_x == Approx(scene.focal_x));
    CHECK(camera.focal_y == Approx(scene.focal_y));
    const glm::dvec2 middle(0.5 * scene.width, 0.5 * scene.height);
    CHECK(glm::length(camera.principal_offset + middle - scene.principal) < 1e-9);
    CHECK(glm::length(camera.position - made.position) < 1e-9);
    CHECK(glm::length(camera.world_from_camera[0] - made.right) < 1e-9);
    CHECK(glm::length(camera.world_from_camera[1] - made.down) < 1e-9);
  }
}

// As nerfstudio's viewer writes it.
std::string path_of(const PhotographedScene& scene, const std::string& more = "") {
  std::string frames;
  for (const MadeCamera& c : scene.cameras) {
    std::string numbers;
    for (int row = 0; row < 3; ++row) {
      numbers += fmt::format("{}, {}, {}, {}, ", c.right[row], -c.down[row], -c.forward[row],
                             c.position[row]);
    }
    frames += fmt::format("{}{{\"camera_to_world\": [{}0, 0, 0, 1], \"fov\": {}, \"aspect\": 1.3}}",
                          frames.empty() ? "" : ",\n", numbers,
                          2 * std::atan(0.5 * scene.height / scene.focal_y) * 180 / M_PI);
  }
  return fmt::format(
      "{{{}\"render_width\": {}, \"render_height\": {}, \"fps\": 24, \"seconds\": 1,"
      " \"camera_path\": [{}]}}",
      more, scene.width, scene.height, frames);
}

}  // namespace

TEST_CASE("view cameras: of all layouts, as files and as folders, without their images") {
  PhotographedScene scene = made_scene();
  struct Row {
    WriteDataset write;
    std::vector<std::string> paths;
    std::vector<std::size_t> which = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
    const char* images = "images";
  };
  for (const Row& row :
       std::vector<Row>{{write_colmap_binary, {"", "sparse", "sparse/0", "sparse/0/images.bin"}},
                        {write_colmap_text, {"", "sparse/0", "sparse/0/cameras.txt"}},
                        {write_transforms, {"", "transforms.json"}},
                        {write_cameras_json, {"", "cameras.json"}},
                        {write_nsvf_focal, {""}, {0, 1, 2, 3, 4, 5, 8, 9}, "rgb"}}) {
    const ScratchFolder scratch;
    row.write(scratch.path("set"), scene);
    const std::string images = scratch.path("set/" + std::string(row.images));
    std::filesystem::remove_all(images);
    std::filesystem::create_directory(images);
    for (const std::string& path : row.paths) {
      INFO(path);
      const ViewCameras read = read_view_cameras(scratch.path("set/" + path));
      check_made(read, scene, row.which);
      CHECK(read.note.empty());
      CHECK_FALSE(read.files.empty());
    }
  }
  const ScratchFolder scratch;
  check_made(read_view_cameras(scratch.write("path.json", path_of(scene))), scene);
}

TEST_CASE("view cameras: a file keeps its order, a folder has that of the data set") {
  PhotographedScene scene = made_scene();
  const ScratchFolder scratch;
  write_transforms(scratch.path(""), scene);
  // The names of the first two frames change places.
  replace("transforms.json", "shot_00", "shot_xx")(scratch.path(""));
  replace("transforms.json", "shot_01", "shot_00")(scratch.path(""));
  replace("transforms.json", "shot_xx", "shot_01")(scratch.path(""));
  check_made(read_view_cameras(scratch.path("transforms.json")), scene);
  const ViewCameras sorted = read_view_cameras(scratch.path(""));
  check_made(sorted, scene, {1, 0, 2, 3, 4, 5, 6, 7, 8, 9});
  const Dataset dataset = open_dataset(scratch.path(""));
  for (std::size_t i = 0; i < dataset.views.size(); ++i) {
    CHECK(sorted.cameras[i].name == dataset.views[i].name);
    CHECK(sorted.cameras[i].position == dataset.views[i].camera.position);
  }
}

TEST_CASE("view cameras: sizes that images alone tell are theirs, or refused") {
  const ScratchFolder scratch;
  write_nerf_synthetic(scratch.path(""), made_scene());
  PhotographedScene scene = made_scene();
  check_made(read_view_cameras(scratch.path("")), scene);
  check_made(read_view_cameras(scratch.path("transforms_train.json")), scene,
             {3, 4, 5, 6, 7, 8, 9});
  std::filesystem::remove_all(scratch.path("train"));
  CHECK_THAT(input_error_of([&] { read_view_cameras(scratch.path("transforms_train.json")); }),
             Contains("transforms_train.json: frame 0: no image './train/shot_03'"));
}

TEST_CASE("view cameras: lenses and names that are not read are said") {
  const ScratchFolder scratch;
  write_transforms(scratch.path(""), made_scene());
  replace("transforms.json", "\"k1\": 0.0", "\"applied_scale\": 2, \"k1\": 0.1")(scratch.path(""));
  const ViewCameras read = read_view_cameras(scratch.path("transforms.json"));
  check_made(read, made_scene());
  CHECK(read.note ==
        "10 cameras have a lens (OPENCV) and are drawn as pinholes of its focal lengths; not read: "
        "applied_scale");
}

TEST_CASE("view cameras: what a camera path of nerfstudio says of itself, by table") {
  struct Row {
    const char *from, *to;
    double frame_rate;
    bool closed;
    const char* note;
  };
  for (const Row& row : std::vector<Row>{
           {"\"fps\": 24, \"seconds\": 1", "\"fps\": 24, \"seconds\": 0.4", 24, false, ""},
           {"\"fps\": 24, \"seconds\": 1", "\"fps\": 24, \"is_cycle\": true", 24, true, ""},
           {"\"fps\": 24, \"seconds\": 1", "\"seconds\": 0.5", 20, false, ""},
           {"\"fps\": 24, ", "\"fps\": 24, ", 10, false,
            "not read: fps of 24, where 10 frames in 1 s are 10 a second"},
           {"\"seconds\": 1", "\"keyframes\": [], \"gain\": 2", 24, false, "not read: gain"}}) {
    INFO(row.to);
    const ScratchFolder scratch;
    std::string text = path_of(made_scene());
    const std::string from = row.from;
    text.replace(text.find(from), from.size(), row.to);
    const ViewCameras read = read_view_cameras(scratch.write("p.json", text));
    check_made(read, made_scene());
    CHECK(read.path.each_frame);
    CHECK(read.path.frame_rate == row.frame_rate);
    CHECK(read.path.closed == row.closed);
    CHECK(read.note == row.note);
  }
}

TEST_CASE("view cameras: the axes that each form states") {
  const ScratchFolder scratch;
  for (const auto& [write, axes] : std::vector<std::pair<WriteDataset, std::string>>{
           {write_colmap_text, "from world to camera, whose axes are right, down and forward"},
           {write_transforms, "from camera to world, columns right, up and backward"},
           {write_cameras_json, "from camera to world, columns right, down and forward"},
           {write_nsvf_focal, "from camera to world, columns right, down and forward"}}) {
    const ScratchFolder set;
    write(set.path(""), made_scene());
    CHECK(read_view_cameras(set.path("")).cameras[3].axes == axes);
  }
  CHECK(read_view_cameras(scratch.write("p.json", path_of(made_scene()))).cameras[3].axes ==
        "from camera to world, columns right, up and backward");
}

TEST_CASE("view cameras refuse: in a line with file, place, what is there and what was expected") {
  const ScratchFolder scratch;
  PhotographedScene scene = made_scene();
  const auto refusal = [&](const std::string& document) {
    return input_error_of([&] { read_view_cameras(scratch.write("p.json", document)); });
  };
  CHECK_THAT(refusal("{}"),
             Contains("p.json: got an object without cameras, frames and camera_path"));
  CHECK_THAT(refusal("3"), Contains("p.json: got 3, expected an array of cameras"));
  CHECK_THAT(refusal(path_of(scene, "\"camera_type\": \"equirectangular\", ")),
             Contains("p.json: camera_type: got equirectangular, expected perspective"));
  std::string one_fisheye = path_of(scene);
  one_fisheye.insert(one_fisheye.find("\"fov\""), "\"camera_type\": \"fisheye\", ");
  CHECK_THAT(refusal(one_fisheye), Contains("camera_type: got fisheye, expected perspective"));
  CHECK_THAT(refusal(path_of(scene, "\"crop\": {}, ")),
             Contains("p.json: crop: got {}, expected null"));
  const std::string good = path_of(scene, "\"crop\": null, \"camera_type\": \"perspective\", ");
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return refusal(text.replace(at, from.size(), to));
  };
  CHECK_THAT(changed("\"render_width\": 64", "\"render_width\": 0"),
             Contains("p.json: render_width: got 0, expected a whole number of px"));
  CHECK_THAT(changed("\"render_height\": 48", "\"was\": 48"),
             Contains("p.json: render_height: got nothing, expected a whole number of px"));
  CHECK_THAT(changed("\"fov\": ", "\"was\": "),
             Contains("p.json: camera_path[0].fov: got nothing, expected degrees"));
  CHECK_THAT(changed("\"fps\": 24", "\"fps\": 0"),
             Contains("p.json: fps: got 0, expected above 0"));
  CHECK_THAT(changed("\"seconds\": 1", "\"is_cycle\": 1"),
             Contains("p.json: is_cycle: got 1, expected true or false"));
  CHECK_THAT(changed("\"fov\": ", "\"fov\": 9"), Contains("p.json: camera_path[0].fov: got 9"));
  CHECK_THAT(changed("\"camera_to_world\": [", "\"camera_to_world\": [1, "),
             Contains("camera_path[0].camera_to_world: got 17 numbers, expected 16"));
  CHECK_THAT(changed("0, 0, 0, 1]", "0, 0, 1, 1]"),
             Contains("camera_path[0].camera_to_world: got 1"));
  CHECK_THAT(refusal(R"({"camera_path": 1, "render_width": 9, "render_height": 9})"),
             Contains("p.json: camera_path: got 1, expected an array"));
  CHECK_THAT(input_error_of([&] { read_view_cameras(scratch.path("none")); }), Contains("none"));
  std::filesystem::create_directory(scratch.path("empty"));
  CHECK_THAT(input_error_of([&] { read_view_cameras(scratch.path("empty")); }),
             Contains("empty: holds no data set, expected one of: "));
  scene.principal = {65, 24};
  write_transforms(scratch.path("out"), scene);
  CHECK_THAT(
      input_error_of([&] { read_view_cameras(scratch.path("out")); }),
      Contains("transforms.json: frame 0: principal point: got x at 65 px of 64, expected it in "
               "the picture"));
}
