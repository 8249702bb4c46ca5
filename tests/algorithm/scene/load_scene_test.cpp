// load_scene.h: names, options, and what is no scene.
#include "algorithm/scene/load_scene.h"

#include <catch2/catch.hpp>
#include <cmath>

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
  CHECK(scene.cloud.size() == 50);
  CHECK(scene.cameras.empty());
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

TEST_CASE("load scene refuses: other extensions, missing files") {
  const test::ScratchFolder scratch;
  CHECK_THAT(test::input_error_of([&] { load_scene(scratch.write("a.obj", "x")); }),
             Contains("got the extension \".obj\", expected a .ply file"));
  test::input_error_of([] { load_scene(""); });
  test::input_error_of([&] { load_scene(scratch.path("none.ply")); });
}
