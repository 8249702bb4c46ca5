// open_scene.h: built-in scenes beside files, and what is neither.
#include "testbench/builtin/open_scene.h"

#include <catch2/catch.hpp>

#include "algorithm/scene/ply_writer.h"
#include "tests/support/scratch_folder.h"

using namespace sgs;
using Catch::Matchers::Contains;

TEST_CASE("open scene: built-in scenes bring their cameras") {
  const Scene scene = open_scene("builtin:outdoor?n=100");
  CHECK(scene.name == "outdoor");
  CHECK(scene.cloud.size() == 100);
  CHECK(scene.cameras.size() >= 4);
}

TEST_CASE("open scene: a file is loaded with the options given") {
  const test::ScratchFolder scratch;
  GaussianCloud cloud = open_scene("builtin:object?n=50").cloud;
  cloud.opacity_logits[7] = NAN;
  write_ply(scratch.path("a.ply"), cloud);
  const Scene scene = open_scene(scratch.path("a.ply"), {true});
  CHECK(scene.name == "a");
  CHECK(scene.cloud.size() == 49);
  CHECK(scene.cameras.empty());
  CHECK(scene.dropped_invalid == 1);
}

TEST_CASE("open scene refuses: unknown names, missing files, other extensions") {
  const test::ScratchFolder scratch;
  for (const std::string spec : {"", "object", "none.ply"}) {
    CHECK_THAT(test::input_error_of([&] { open_scene(spec); }),
               Contains(spec + ": no such file, expected a scene ("));
  }
  CHECK_THAT(test::input_error_of([&] { open_scene(scratch.write("a.obj", "x")); }),
             Contains("got the extension \".obj\""));
  test::input_error_of([] { open_scene("builtin:"); });
}
