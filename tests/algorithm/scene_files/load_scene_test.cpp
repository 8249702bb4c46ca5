// load_scene.h: names, options, and what is no scene.
#include "algorithm/scene_files/load_scene.h"

#include <catch2/catch.hpp>
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

TEST_CASE("load scene: axes that are given are turned to right, down, forward") {
  const test::ScratchFolder scratch;
  const GaussianCloud cloud = make_builtin_scene("builtin:object?n=50").cloud;
  write_ply(scratch.path("a.ply"), cloud);
  SceneReadOptions options;
  options.axes = "rfu";
  const Scene scene = load_scene(scratch.path("a.ply"), options);
  CHECK(scene.axes == "rfu");
  CHECK(scene.notes == std::vector<std::string>{"turned from axes rfu to right, down, forward"});
  for (std::size_t i = 0; i < 50; ++i) {
    const glm::vec3& mean = cloud.means[i];
    CHECK(scene.cloud.means[i] == glm::vec3(mean.x, -mean.z, mean.y));
  }
  options.axes = "rdf";
  CHECK(load_scene(scratch.path("a.ply"), options).axes.empty());
  options.axes = "ruf";
  CHECK_THAT(test::input_error_of([&] { load_scene(scratch.path("a.ply"), options); }),
             Contains("a.ply: got the axes ruf, expected r or l"));
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
