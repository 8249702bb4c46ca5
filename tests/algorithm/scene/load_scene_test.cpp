// load_scene.h: names, sources, and what is neither.
#include "algorithm/scene/load_scene.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "algorithm/scene/builtin_scene.h"
#include "algorithm/scene/ply_writer.h"
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

TEST_CASE("load scene: built-in scenes bring their cameras") {
  const Scene scene = load_scene("builtin:outdoor?n=100");
  CHECK(scene.name == "outdoor");
  CHECK(scene.cloud.size() == 100);
  CHECK(scene.cameras.size() >= 4);
}

TEST_CASE("load scene refuses: other extensions, missing files, unknown names") {
  const test::ScratchFolder scratch;
  CHECK_THAT(test::input_error_of([&] { load_scene(scratch.write("a.obj", "x")); }),
             Contains("got the extension \".obj\", expected a .ply file or builtin:NAME"));
  test::input_error_of([] { load_scene(""); });
  test::input_error_of([&] { load_scene(scratch.path("none.ply")); });
  test::input_error_of([] { load_scene("builtin:"); });
}
