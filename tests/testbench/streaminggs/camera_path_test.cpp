// Paths from files and built-in scenes, frames between their keys, what frames come to, and the
// sheet that shows them.
#include "testbench/streaminggs/run/camera_path.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "algorithm/scene/camera.h"
#include "testbench/builtin/builtin_scene.h"
#include "testbench/streaminggs/report/contact_sheet.h"
#include "testbench/streaminggs/run/path_summary.h"
#include "tests/support/scratch_folder.h"

namespace sgs::test {
namespace {

using nlohmann::json;

Camera at_x(double x, double focal = 500) {
  Camera camera = look_at(0, "c", {x, 0, -5}, {x, 0, 0}, 50);
  camera.focal_x = focal;
  return camera;
}

TEST_CASE("camera between: the ends to the bit, half the way and half the turn") {
  const Camera a = look_at(3, "a", {0, 0, -5}, {0, 0, 0}, 50);
  const Camera b = look_at(4, "b", {5, 0, 0}, {0, 0, 0}, 50);
  CHECK(camera_between(a, b, 0).world_from_camera == a.world_from_camera);
  CHECK(camera_between(a, b, 1).world_from_camera == b.world_from_camera);
  CHECK(camera_between(a, b, 1).position == b.position);
  CHECK(camera_between(a, b, 1).id == 3);
  const Camera half = camera_between(a, b, 0.5);
  CHECK(glm::length(half.position - glm::dvec3(2.5, 0, -2.5)) < 1e-12);
  CHECK(glm::length(half.world_from_camera[2] - glm::normalize(glm::dvec3(-1, 0, 1))) < 1e-12);
}

TEST_CASE("camera path: frames between keys, by table") {
  struct Row {
    bool closed;
    std::uint32_t count;
    std::vector<double> xs;
  };
  for (const Row& row : std::vector<Row>{{false, 1, {0}},
                                         {false, 2, {0, 6}},
                                         {false, 3, {0, 2, 6}},  // as many on a longer leg
                                         {false, 5, {0, 1, 2, 4, 6}},
                                         {true, 1, {0}},
                                         {true, 3, {0, 2, 6}},
                                         {true, 6, {0, 1, 2, 4, 6, 3}}}) {
    INFO(row.closed << " " << row.count);
    const CameraPath path{
        "p", {at_x(0, 100), at_x(2, 200), at_x(6, 400)}, {row.closed, false, {}}, ""};
    const std::vector<Camera> frames = frames_along(path, row.count);
    REQUIRE(frames.size() == row.xs.size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
      CHECK(frames[i].position.x == Approx(row.xs[i]));
      // Of this path focal lengths go with x.
      CHECK(frames[i].focal_x ==
            Approx(row.xs[i] <= 2 ? 100 + 50 * row.xs[i] : 50 * row.xs[i] + 100)
                .margin(row.closed && i == 5 ? 1e3 : 1e-9));
      CHECK(frames[i].id == static_cast<int>(i));
    }
  }
  CameraPath mixed{"p", {at_x(0), at_x(1)}, {}, ""};
  mixed.keys[1].height = 99;
  CHECK(input_error_of([&] { frames_along(mixed, 3); }) ==
        "p: camera 1: got 640x99 px, expected the 640x360 of the first, or --size for all");
}

TEST_CASE("camera path: files and built-in ways, by table") {
  const ScratchFolder scratch;
  write_cameras(scratch.path("cameras.json"), {at_x(0), at_x(2), at_x(6)});
  const json cameras = json::parse(bytes_of(scratch.path("cameras.json")));
  const auto read = [&](const json& document, const char* scene = "scene.ply") {
    return read_camera_path(scratch.write("path.json", document.dump()), scene);
  };
  CHECK(read(cameras).keys.size() == 3);
  CHECK_FALSE(read(cameras).facts.closed);
  CHECK(read({{"cameras", cameras}}).keys[2].position.x == 6);
  CHECK(read({{"cameras", cameras}, {"closed", true}}).facts.closed);
  const auto pose = [](double x) {
    return json{{"camera_to_world", {1, 0, 0, x, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}, {"fov", 90}};
  };
  const CameraPath of_nerfstudio = read({{"render_width", 640},
                                         {"render_height", 360},
                                         {"camera_path", {pose(0), pose(3), pose(5)}}});
  REQUIRE(of_nerfstudio.keys.size() == 3);
  CHECK_FALSE(of_nerfstudio.facts.closed);
  CHECK(of_nerfstudio.keys[1].position.x == 3);
  CHECK(of_nerfstudio.keys[1].focal_x == Approx(180));
  // It states each frame; who wants another number has them between these.
  const std::vector<Camera> stated = frames_along(of_nerfstudio, {});
  REQUIRE(stated.size() == 3);
  CHECK(stated[1].position.x == 3);
  CHECK(stated[1].name == "frame_00001");
  CHECK(frames_along(of_nerfstudio, 5)[1].position.x == 1.5);
  CHECK(frames_along(read(cameras), {}).size() == 60);
  std::filesystem::create_directory(scratch.path("set"));
  scratch.write("set/cameras.json", cameras.dump());
  CHECK(read_camera_path(scratch.path("set"), "scene.ply").keys.size() == 3);

  struct Row {
    json document;
    std::string says;
  };
  const auto one = json::array({cameras[0]});
  for (const Row& row : std::vector<Row>{
           {json::array(), "got 0 cameras, expected two or more"},
           {one, "got 1 cameras, expected two or more"},
           {3, "got 3, expected an array of cameras"},
           {json::object(), "got an object without cameras, frames and camera_path"},
           {{{"cameras", 3}}, "cameras: got 3, expected an array"},
           {{{"cameras", cameras}, {"closed", 1}}, "closed: got 1, expected true or false"},
           {{{"cameras", cameras}, {"loop", 1}},
            "loop: unknown key, expected one of cameras, closed"},
           {json::array({cameras[0], 1}), "camera 1: got 1, expected an object"}}) {
    const std::string error = input_error_of([&] { read(row.document); });
    INFO(error);
    CHECK(error.find(row.says) != std::string::npos);
    CHECK(error.find(scratch.path("path.json")) == 0);
  }
  CHECK(input_error_of([&] {
          read_camera_path("builtin:path", "scene.ply");
        }).find("builtin:path with scene.ply, which is no built-in scene") != std::string::npos);
  CHECK(input_error_of([&] { read_camera_path(scratch.path("none"), "s"); }).find("none") !=
        std::string::npos);
}

TEST_CASE("camera path: the turntable and the walk of the built-in scenes") {
  const CameraPath turntable = read_camera_path("builtin:path", "builtin:object?n=10");
  CHECK(turntable.facts.closed);
  double least = 9, most = 0;
  for (const Camera& camera : frames_along(turntable, 100)) {
    const double distance = glm::length(glm::dvec2(camera.position.x, camera.position.z));
    least = std::min(least, distance);
    most = std::max(most, distance);
    const glm::dvec3 to_axis = glm::normalize(glm::dvec3(0, -1.08, 0) - camera.position);
    CHECK(glm::dot(to_axis, camera.world_from_camera[2]) > 0.999);
  }
  CHECK(most == Approx(5.6));
  CHECK(least > 0.995 * most);
  const CameraPath walk = read_camera_path("builtin:path", "builtin:outdoor");
  CHECK_FALSE(walk.facts.closed);
  const std::vector<Camera> frames = frames_along(walk, 200);
  for (std::size_t i = 1; i < frames.size(); ++i) {  // no step longer than a man's
    CHECK(glm::length(frames[i].position - frames[i - 1].position) < 0.1);
  }
}

TEST_CASE("path summary: by table") {
  struct Row {
    std::vector<double> times_ms;
    double worst, p99, median;
    std::size_t worst_frame, late;
    double frames_w, idle_w;
  };
  std::vector<double> hundred(100, 10);
  hundred[7] = 20;
  for (const Row& row :
       std::vector<Row>{{{10}, 100, 100, 100, 0, 0, 3.0 / 20, 0.5 * 10 / 20},
                        {{20}, 50, 50, 50, 0, 0, 3.0 / 20, 0},  // as long as a slot: not late
                        {{40}, 25, 25, 25, 0, 1, 3.0 / 40, 0},
                        {{10, 40, 5}, 25, 25, 100, 1, 1, 9.0 / 80, 0.5 * 25 / 80},
                        {hundred, 50, 100, 100, 7, 0, 3.0 / 20, 0.5 * 990 / 2000}}) {
    std::vector<PathFrame> frames;
    for (const double ms : row.times_ms) {
      const double rest_j = 0.5 * std::max(0.0, 20 - ms) / 1e3;
      frames.push_back({ms / 1e3,
                        {2e-3, 3e-3, 5e-3},
                        {rest_j / 2, rest_j, 4 * rest_j},
                        {3e-3 + rest_j, 7e-3, 9e-3},
                        ms > 10});
    }
    const PathSummary s = summarise(frames, 50);
    CHECK(s.worst_fps == Approx(row.worst));
    CHECK(s.p99_fps == Approx(row.p99));
    CHECK(s.median_fps == Approx(row.median));
    CHECK(s.worst_frame == row.worst_frame);
    CHECK(s.late == row.late);
    CHECK(s.frames == row.times_ms.size());
    CHECK(s.empty ==
          static_cast<std::size_t>(std::count_if(row.times_ms.begin(), row.times_ms.end(),
                                                 [](double ms) { return ms > 10; })));
    CHECK(s.energy_j == Approx(3e-3 * static_cast<double>(s.frames)));
    CHECK(s.rate == 50);
    CHECK(s.frames_w.middle == Approx(row.frames_w));
    CHECK(s.frames_w.low == Approx(row.frames_w * 2 / 3));
    CHECK(s.frames_w.high == Approx(row.frames_w * 5 / 3));
    CHECK(s.idle_w.middle == Approx(row.idle_w));
    CHECK(s.with_interface_w.low == Approx(row.frames_w + row.idle_w));
    CHECK(s.with_interface_w.middle == Approx(row.frames_w * 7 / 3));
    CHECK(s.idle_w.low == Approx(row.idle_w / 2));
    CHECK(s.idle_w.high == Approx(row.idle_w * 4));
  }
}

TEST_CASE("contact sheet: evenly spread tiles, each the mean of its pixels") {
  const ContactSheet many(600), few(3);
  std::size_t shown = 0;
  for (std::size_t i = 0; i < 600; ++i) shown += many.shows(i) ? 1 : 0;
  CHECK(shown == ContactSheet::kMostTiles);
  CHECK((many.shows(0) && many.shows(10) && !many.shows(11)));
  CHECK((few.shows(0) && few.shows(2)));
  ContactSheet sheet(8);
  for (int i = 0; i < 8; ++i) {
    Image picture(640, 4);
    for (int x = 0; x < 640; ++x) {
      for (int y = 0; y < 4; ++y) picture.at(x, y) = glm::vec3(x % 2 == 0 ? 0.1F * i : 7.0F);
    }
    sheet.add(picture, "LINE");
  }
  const Image out = sheet.sheet();
  CHECK(out.width == 6 * 328 + 8);
  CHECK(out.height == 2 * (2 + 18 + 8) + 8);
  CHECK(out.at(8, 8).x == Approx(0.5));                  // of 0 and what is clamped to 1
  CHECK(out.at(8 + 328, 8 + 28 + 1).x == Approx(0.85));  // the eighth: second row, second column
  CHECK(out.at(8 + 2 * 328, 8 + 28).x == Approx(0.1));   // paper
}

}  // namespace
}  // namespace sgs::test
