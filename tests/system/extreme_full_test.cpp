// The largest of the extreme inputs through every machine, the packer and the tuner.
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "algorithm/scene/camera.h"
#include "algorithm/scene/ply_reader.h"
#include "algorithm/scene/ply_writer.h"
#include "tests/system/extreme_scenes.h"

namespace sgs::test {
namespace {

GaussianCloud a_million_at_one_point() {
  GaussianCloud cloud;
  for (int i = 0; i < 1000000; ++i) {
    const float shade = static_cast<float>(i % 50) / 50;
    add(cloud, {0.01F, 0.02F, 0}, -2.3F, 0, {shade, 1 - shade, 0.5F});
  }
  return cloud;
}

// Opacity 2/255, so that 1/255 is blended in the middle of each.
GaussianCloud layers_of_haze() {
  GaussianCloud cloud;
  for (int i = 0; i < 100000; ++i) {
    add(cloud, {0, 0, 1e-4F * static_cast<float>(i)}, 0, -4.84F, {1, 1, 1});
  }
  return cloud;
}

// Details of 10^-3 among extents over 10^5.
GaussianCloud near_and_far() {
  GaussianCloud cloud;
  for (int i = 0; i < 20000; ++i) {
    const float x = static_cast<float>(i % 140) / 70 - 1, y = static_cast<float>(i / 140) / 70 - 1;
    add(cloud, {x, y, 0}, -6.9F, 3, {1, 0.5F + 0.5F * x, 0});
    add(cloud, {2e5F * x, 2e5F * y, 1e5F}, 7, 3, {0, 0.5F + 0.5F * y, 1});
  }
  return cloud;
}

void check_everything(const GaussianCloud& cloud) {
  const std::vector<Camera> cameras = {camera_at({0, 0, -5}, 64, 36)};
  for (const nlohmann::json& view : check_scene(cloud, cameras)) {
    CHECK(view["image"]["blends"].get<int>() > 0);
    // Orders without loss draw the reference, at the very bits.
    const bool lossless = view["config"]["machine"] == "exact" ||
                          view["provenance"]["configuration"] == "gscore_lossless";
    if (lossless) CHECK(view["image"]["max_abs_error"] == 0.0);
  }
  const ScratchFolder scratch;
  const std::string scene = scratch.path("scene.ply"), file = scratch.path("cameras.json");
  write_ply(scene, cloud);
  write_cameras(file, cameras);
  for (const char* encoding : {"exact", "exact_vq"}) {
    INFO("packed for " << encoding);
    const Outcome packed =
        run_streaminggs({"pack", scene, "--config", encoding, "--out", scratch.path("scene.sgs")});
    INFO(packed.err);
    REQUIRE(packed.status == 0);
    const Simulation of_packed(
        {scratch.path("scene.sgs"), "--cameras", file, "--config", encoding});
    const Simulation of_file({scene, "--cameras", file, "--config", encoding});
    of_packed.check();
    CHECK(of_packed.frame(0) == of_file.frame(0));
  }
  const Outcome tuned = run_streaminggs({"tune", scene, "--cameras", file, "--boundary", "--steps",
                                         "2", "--out", scratch.path("tuned.ply")});
  INFO(tuned.err);
  REQUIRE(tuned.status == 0);
  CHECK(read_ply(scratch.path("tuned.ply")).cloud.size() == cloud.size());  // and all is finite
}

TEST_CASE("largest extremes: a million at one point", "[nightly]") {
  check_everything(a_million_at_one_point());
}
TEST_CASE("largest extremes: 10^5 layers of 1/255", "[nightly]") {
  check_everything(layers_of_haze());
}
TEST_CASE("largest extremes: details of 10^-3, extents of 10^5", "[nightly]") {
  check_everything(near_and_far());
}

}  // namespace
}  // namespace sgs::test
