// cameras.json: its form, its errors, what is written; resizing.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "algorithm/dataset/view_cameras.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/shared_inputs.h"

using namespace sgs;
using Catch::Matchers::Contains;
using Json = nlohmann::json;

namespace {

// Camera x, y, z axes in the world are (0, 0, 1), (0, 1, 0), (-1, 0, 0): the columns.
Json one_camera() {
  return Json::parse(R"({"id": 7, "img_name": "front", "width": 640, "height": 360,
    "position": [1.5, -2, 3], "rotation": [[0, 0, -1], [0, 1, 0], [1, 0, 0]],
    "fx": 500.25, "fy": 400.5, "extra": [1]})");
}

std::vector<Camera> read_cameras(const std::string& path) {
  return read_view_cameras(path).cameras;
}

std::string refusal(const Json& json) {
  const test::ScratchFolder scratch;
  const std::string path = scratch.write("cams.json", json.dump());
  const std::string message = test::input_error_of([&] { read_cameras(path); });
  CHECK_THAT(message, Contains("cams.json: "));
  return message;
}

// The message when `key` of the second camera is `value`.
std::string refusal_of(const char* key, const Json& value) {
  Json bad = one_camera();
  bad[key] = value;
  const std::string message = refusal({one_camera(), bad});
  CHECK_THAT(message, Contains("camera 1: "));
  return message;
}

}  // namespace

TEST_CASE("cameras: the columns of the stored rotation are the camera's axes") {
  const test::ScratchFolder scratch;
  const auto cameras = read_cameras(scratch.write("a.json", Json::array({one_camera()}).dump()));
  REQUIRE(cameras.size() == 1);
  const Camera& camera = cameras[0];
  CHECK(camera.id == 7);
  CHECK(camera.name == "front");
  CHECK(camera.width == 640);
  CHECK(camera.height == 360);
  CHECK(camera.focal_x == 500.25);
  CHECK(camera.focal_y == 400.5);
  CHECK(camera.position == glm::dvec3(1.5, -2, 3));
  CHECK(camera.world_from_camera[0] == glm::dvec3(0, 0, 1));
  CHECK(camera.world_from_camera[1] == glm::dvec3(0, 1, 0));
  CHECK(camera.world_from_camera[2] == glm::dvec3(-1, 0, 0));
}

TEST_CASE("cameras: a principal point beside the middle is read, written and scaled") {
  const test::ScratchFolder scratch;
  Json beside = one_camera();
  beside["cx"] = 300.25;
  const Camera camera = read_cameras(scratch.write("a.json", Json::array({beside}).dump()))[0];
  CHECK(camera.principal_offset == glm::dvec2(-19.75, 0));
  write_cameras(scratch.path("b.json"), {camera});
  CHECK(read_cameras(scratch.path("b.json"))[0].principal_offset == camera.principal_offset);
  CHECK(scaled_to(camera, 320, 90).principal_offset == glm::dvec2(-9.875, 0));
  beside["cy"] = 45;
  const Camera both = read_cameras(scratch.write("a.json", Json::array({beside}).dump()))[0];
  CHECK(scaled_to(both, 320, 90).principal_offset == glm::dvec2(-9.875, -33.75));
  // In the middle nothing is written: the file is the original's.
  write_cameras(scratch.path("c.json"),
                read_cameras(scratch.write("a.json", Json::array({one_camera()}).dump())));
  CHECK(test::bytes_of(scratch.path("c.json")).find("cx") == std::string::npos);
  CHECK_THAT(refusal_of("cx", 640.5),
             Contains("principal point: got x at 640.5 px of 640, expected it in the picture"));
  CHECK_THAT(refusal_of("cy", -1), Contains("principal point: got y at -1 px of 360"));
  CHECK_THAT(refusal_of("cy", "x"), Contains("cy: got \"x\", expected a finite number"));
}

TEST_CASE("cameras: lenses and unknown keys are judged as in other forms, by table") {
  struct Row {
    const char* key;
    Json value;
    const char* says;  // beside `extra`, which is not read: what is noted or refused
  };
  const char* kDrawn =
      "1 cameras have a lens (OPENCV) and are drawn as pinholes of its focal lengths; ";
  for (const Row& row :
       std::vector<Row>{{"k1", 0.1, kDrawn},
                        {"k1", 0, ""},
                        {"distortion_params", {0.1, 0, 0, 0, 0, 0}, kDrawn},
                        {"is_fisheye", true,
                         "1 cameras have a lens (OPENCV_FISHEYE) and are drawn as pinholes of its "
                         "focal lengths; "},
                        {"mask_path", "m.png", ""},
                        {"k4", 0.5, "k4: got 0.5, expected 0"},
                        {"camera_model", "EQUIRECTANGULAR", "got the camera model EQUIRECTANGULAR"},
                        {"rolling_shutter", {0, 0.5}, "rolling_shutter[1]: got 0.5, expected 0"},
                        {"k1", "x", "k1: got \"x\", expected a finite number"},
                        {"mask_path", 1, "mask_path: got 1, expected a text"}}) {
    INFO(row.key << " " << row.value);
    const test::ScratchFolder scratch;
    Json camera = one_camera();
    camera[row.key] = row.value;
    const std::string path = scratch.write("cams.json", Json::array({camera}).dump());
    const std::string says = row.says;
    if (says.find(" got ") == std::string::npos && says.find("got the") == std::string::npos) {
      CHECK(read_view_cameras(path).note == says + "not read: extra");
    } else {
      CHECK_THAT(test::input_error_of([&] { read_cameras(path); }),
                 Contains("cams.json: camera 0: " + says));
    }
  }
}

TEST_CASE("cameras: no cameras, and sizes written as floats") {
  const test::ScratchFolder scratch;
  CHECK(read_cameras(scratch.write("a.json", "[]")).empty());
  Json camera = one_camera();
  camera["width"] = 640.0;
  CHECK(read_cameras(scratch.write("b.json", Json::array({camera}).dump()))[0].width == 640);
}

TEST_CASE("cameras: written and read back bit for bit") {
  const test::ScratchFolder scratch;
  Camera camera = read_cameras(scratch.write("a.json", Json::array({one_camera()}).dump()))[0];
  camera.position = {0.1, 1.0 / 3.0, -1e-17};
  camera.focal_x = 457.00736215747671;
  // A rotation about z with entries that have no short decimal form.
  const double c = 0.8574929257125442, s = 0.5144957554275265;
  camera.world_from_camera = {{c, s, 0}, {-s, c, 0}, {0, 0, 1}};
  camera.name = "quote \" and \\ and \xc3\xa9";
  write_cameras(scratch.path("b.json"), {camera, camera});
  const auto back = read_cameras(scratch.path("b.json"));
  REQUIRE(back.size() == 2);
  CHECK(back[1].position == camera.position);
  CHECK(back[1].focal_x == camera.focal_x);
  CHECK(back[1].world_from_camera == camera.world_from_camera);
  CHECK(back[1].name == camera.name);
  CHECK(back[1].id == camera.id);
}

TEST_CASE("cameras: every missing key is named") {
  for (const char* key :
       {"id", "img_name", "width", "height", "position", "rotation", "fx", "fy"}) {
    Json bad = one_camera();
    bad.erase(key);
    CHECK_THAT(refusal({one_camera(), bad}),
               Contains(std::string("camera 1: ") + key + ": got nothing, expected"));
  }
}

TEST_CASE("cameras: wrong types and impossible values are named") {
  CHECK_THAT(refusal_of("id", "7"), Contains("id: got \"7\", expected a whole number"));
  CHECK_THAT(refusal_of("id", 1.5), Contains("id: got 1.5"));
  CHECK_THAT(refusal_of("img_name", 3), Contains("img_name: got 3, expected a text"));
  CHECK_THAT(refusal_of("width", 0), Contains("width: got 0"));
  CHECK_THAT(refusal_of("width", -640), Contains("width: got -640"));
  CHECK_THAT(refusal_of("height", 360.5), Contains("height: got 360.5"));
  CHECK_THAT(refusal_of("height", 1e12), Contains("height: got"));
  CHECK_THAT(refusal_of("height", nullptr), Contains("height: got null"));
  CHECK_THAT(refusal_of("fx", 0), Contains("focal length: got 0, expected px above 0"));
  CHECK_THAT(refusal_of("fy", -3.5), Contains("focal length: got -3.5"));
  CHECK_THAT(refusal_of("fy", "wide"), Contains("fy: got \"wide\", expected a finite number"));
  CHECK_THAT(
      refusal_of("fx", 1e12),
      Contains(
          "cams.json: camera 1: focal length: got 1000000000000, expected px above 0, at most"));
  CHECK_THAT(refusal_of("position", {0, -1e30, 0}),
             Contains("position: got (0, -1e+30, 0), expected finite numbers of at most 1e+18"));
  CHECK_THAT(refusal_of("position", {1, 2}), Contains("position: got [1,2], expected 3 numbers"));
  CHECK_THAT(refusal_of("position", {1, "a", 2}), Contains("position[1]: got \"a\""));
  CHECK_THAT(refusal_of("position", 5), Contains("position: got 5"));
  CHECK_THAT(refusal_of("rotation", {{1, 0, 0}, {0, 1, 0}}), Contains("3 rows of 3 numbers"));
  CHECK_THAT(refusal_of("rotation", {{1, 0, 0}, {0, 1, 0}, {0, 1}}),
             Contains("rotation[2]: got [0,1]"));
  CHECK_THAT(refusal_of("rotation", {{1, 0, 0}, {0, 1, 0}, {0, nullptr, 1}}),
             Contains("rotation[2][1]: got null"));
}

TEST_CASE("cameras: rotations must be orthonormal within 1e-3 and not mirror") {
  const test::ScratchFolder scratch;
  const auto scaled = [](double factor) { return Json({{factor, 0, 0}, {0, 1, 0}, {0, 0, 1}}); };
  CHECK_THAT(refusal_of("rotation", scaled(1.001)), Contains("columns orthonormal within 1e-3"));
  CHECK_THAT(refusal_of("rotation", {{1, 0.002, 0}, {0, 1, 0}, {0, 0, 1}}),
             Contains("off by 0.002"));
  CHECK_THAT(refusal_of("rotation", {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}), Contains("off by 1"));
  CHECK_THAT(refusal_of("rotation", scaled(-1)), Contains("mirrored"));
  Json near = one_camera();
  near["rotation"] = scaled(1.0004);  // its square is off by 0.0008
  CHECK(read_cameras(scratch.write("a.json", Json::array({near}).dump())).size() == 1);
}

TEST_CASE("cameras: files that are no array of cameras") {
  const test::ScratchFolder scratch;
  CHECK_THAT(test::input_error_of([&] { read_cameras(scratch.path("none")); }), Contains("none"));
  CHECK_THAT(refusal(Json::object()),
             Contains("got an object without cameras, frames and camera_path, expected an array"));
  CHECK_THAT(refusal({1, 2}), Contains("camera 0: got 1, expected an object"));
  const std::string whole = Json::array({one_camera()}).dump();
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const std::string path = scratch.write("cut.json", whole.substr(0, size));
    CHECK_THAT(test::input_error_of([&] { read_cameras(path); }), Contains("not JSON"));
  }
  // Numbers beyond double would read as infinity.
  const std::string huge = scratch.write("huge.json", "[{\"id\": 0, \"fx\": 1e999}]");
  test::input_error_of([&] { read_cameras(huge); });
  const std::string twice = scratch.write("twice.json", "[{\"id\": 0, \"id\": 0}]");
  CHECK_THAT(test::input_error_of([&] { read_cameras(twice); }), Contains("key 'id' twice"));
  const std::string deep = scratch.write("deep.json", std::string(80000, '['));
  CHECK_THAT(test::input_error_of([&] { read_cameras(deep); }), Contains("64 deep"));
}

TEST_CASE("cameras: resizing scales the focal lengths by width and by height") {
  Camera camera;
  camera.width = 640;
  camera.height = 360;
  camera.focal_x = 500;
  camera.focal_y = 400;
  const Camera half = scaled_to(camera, 320, 90);
  CHECK(half.width == 320);
  CHECK(half.height == 90);
  CHECK(half.focal_x == 250);
  CHECK(half.focal_y == 100);
  CHECK(scaled_to(camera, 640, 360).focal_x == 500);
  CHECK_THROWS_AS(scaled_to(camera, 0, 10), InputError);
  CHECK_THROWS_AS(scaled_to(camera, 10, -1), InputError);
}

TEST_CASE("cameras: the real views are read", "[shared]") {
  for (const char* name : {"truck", "playbot", "platform", "yard", "garden", "park"}) {
    const auto cameras = read_cameras(test::shared_path("cameras/" + std::string(name) + ".json"));
    CHECK(cameras.size() == 4);
    for (const Camera& camera : cameras) CHECK(camera.width == 640);
  }
}
