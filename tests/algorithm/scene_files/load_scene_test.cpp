// load_scene.h: names, options, and what is no scene.
#include "algorithm/scene_files/load_scene.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>

#include "algorithm/scene/ply_writer.h"
#include "testbench/builtin/builtin_scene.h"
#include "tests/support/scratch_folder.h"

using namespace sgs;
using Catch::Matchers::Contains;

TEST_CASE("load scene: a file is named after itself") {
  const test::ScratchFolder scratch;
  GaussianCloud cloud = make_builtin_scene("builtin:object?n=50").cloud;
  write_ply(scratch.path("my.scene.PLY"), cloud);
  const Scene scene = load_scene(scratch.path("my.scene.PLY"));
  CHECK(scene.name == "my.scene");
  CHECK(scene.form == "PLY");
  CHECK(scene.cloud.size() == 50);
  CHECK(scene.cameras.empty());
  CHECK(scene.notes.empty());
  CHECK(scene.dropped_invalid == 0);
}

TEST_CASE("load scene: the options reach the reader") {
  const test::ScratchFolder scratch;
  GaussianCloud cloud = make_builtin_scene("builtin:object?n=50").cloud;
  cloud.means[7].y = NAN;
  write_ply(scratch.path("a.ply"), cloud);
  CHECK_THAT(test::input_error_of([&] { load_scene(scratch.path("a.ply")); }),
             Contains("vertex 7, property y"));
  const Scene scene = load_scene(scratch.path("a.ply"), {true});
  CHECK(scene.cloud.size() == 49);
  CHECK(scene.dropped_invalid == 1);
}

TEST_CASE("load scene: a form is told by how the file begins") {
  const test::ScratchFolder scratch;
  write_ply(scratch.path("scene.txt"), make_builtin_scene("builtin:object?n=50").cloud);
  CHECK(load_scene(scratch.path("scene.txt")).cloud.size() == 50);
}

TEST_CASE("load scene refuses: other extensions, missing files, folders") {
  const test::ScratchFolder scratch;
  const auto refusal = [](const std::string& path) {
    CHECK_FALSE(is_scene_file(path));
    return test::input_error_of([&] { load_scene(path); });
  };
  CHECK_THAT(
      refusal(scratch.write("a.obj", "x")),
      Contains("got the extension \".obj\", expected a scene (.compressed.ply, .ply, .spz, "));
  CHECK_THAT(refusal(scratch.write("a.lcc", "{}")), Contains("splat-transform makes a .ply"));
  CHECK_THAT(refusal(scratch.write("a.ckpt", "x")), Contains("own trainer exports a .ply"));
  refusal("");
  std::filesystem::create_directories(scratch.path("folder"));
  refusal(scratch.path("folder"));
  test::input_error_of([&] { load_scene(scratch.path("none.ply")); });
}
