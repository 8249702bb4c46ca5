// Extreme inputs through the whole accelerator: right to the bit, or refused by name.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "algorithm/scene/camera.h"
#include "algorithm/scene/ply_writer.h"
#include "tests/system/extreme_scenes.h"
#include "tests/system/report_values.h"
#include "tests/system/streaminggs_run.h"

namespace sgs::test {
namespace {

TEST_CASE("extreme input: a scene of nothing") {
  for (const auto& view : check_scene({}, {camera_at({0, 0, -5})})) {
    CHECK(region_bytes(view, "first_halves", "read") == 0);
    CHECK(region_bytes(view, "frame_buffer", "write") == 65 * 49 * 12);
  }
}

TEST_CASE("extreme input: one Gaussian in front, behind, on the camera, on the near plane") {
  GaussianCloud cloud;
  add(cloud, {0, 0, 0}, kUnitScale, 2, {1, 0.5F, 0});
  const auto views = check_scene(cloud, {camera_at({0, 0, -5}), camera_at({0, 0, 5}),
                                         camera_at({0, 0, 0}), camera_at({0, 0, -0.2})});
  CHECK(views[0]["image"]["blends"].get<int>() > 0);
  CHECK(views[1]["image"]["blends"] == 0);
  CHECK(views[2]["image"]["blends"] == 0);
}

TEST_CASE("extreme input: nobody can see any of it") {
  GaussianCloud cloud;
  for (int i = 0; i < 50; ++i)
    add(cloud, {0.1F * static_cast<float>(i), 0, 0}, kUnitScale, -7, {1, 1, 1});
  for (const auto& view : check_scene(cloud, {camera_at({0, 0, -5})})) {
    CHECK(view["image"]["blends"] == 0);
  }
}

TEST_CASE("extreme input: thousands at one point, all of one depth") {
  GaussianCloud cloud;
  for (int i = 0; i < 3000; ++i) {
    add(cloud, {0.01F, 0.02F, 0}, kUnitScale - static_cast<float>(i % 7) * 0.1F,
        -4 + static_cast<float>(i % 5), {0.3F * static_cast<float>(i % 3), 0.5F, 1});
  }
  const auto views = check_scene(cloud, {camera_at({0, 0, -5})});
  // Paper order cuts them into lists that fit, even where no plane parts them.
  CHECK(total(views[0], "entries_spilled") == 0);
  CHECK(total(views[0], "cuts") > 0);
  const Arguments whole = {"--set", "vsu.visit_gaussians=0"};
  const auto uncut = check_machine("paper", cloud, {camera_at({0, 0, -5})}, whole);
  CHECK(total(uncut[0], "entries_spilled") >= 3000);  // one list of them
  // Long lists and no feedback: every pass runs to its end.
  const Arguments to_the_end = {"--set", "rendering.saturation_feedback=false"};
  check_machine("paper", cloud, {camera_at({0, 0, -5})},
                joined(joined(to_the_end, whole), {"--set", "sorting.buffer_entries=16"}));
  check_machine("exact", cloud, {camera_at({0, 0, -5})},
                with_settings(to_the_end, {"sram.shared_bytes=0", "merge.entries=1024"}));
}

TEST_CASE("extreme input: coordinates of a million, details of a thousandth") {
  GaussianCloud cloud;
  const glm::vec3 far(1e6F, -1e6F, 5e5F);
  for (int i = 0; i < 200; ++i) {
    add(cloud, far + glm::vec3(i % 10, i / 10 % 10, i / 100) * 0.25F, -4, 1,
        {1, 0.1F * static_cast<float>(i % 10), 0});
  }
  add(cloud, -far, 3, 1, {0, 0, 1});
  const auto views = check_scene(
      cloud, {camera_at({1e6 + 1, -1e6 + 1, 5e5 - 4}), camera_at({-1e6, 1e6, -5e5 - 50})},
      {"--set", "storage.voxel_size=10"});
  for (const auto& view : views) CHECK(view["image"]["blends"].get<int>() > 0);
}

TEST_CASE("extreme input: a giant around everything, and a needle") {
  GaussianCloud cloud;
  for (int i = 0; i < 100; ++i) {
    add(cloud, {0.1F * static_cast<float>(i % 10), 0.1F * static_cast<float>(i / 10), 0},
        kUnitScale, 0, {0, 1, 0});
  }
  add(cloud, {0, 0, 1}, 8, -1, {1, 0, 0});
  add(cloud, {0, 0, 0.5F}, 0, 3, {0, 0, 1});
  cloud.log_scales.back() = {5, -18, -18};  // 10^10 from end to end of its scales
  cloud.quats.back() = {0.9F, 0.1F, 0.4F, 0.1F};
  check_scene(cloud, {camera_at({0, 0, -5}), camera_at({0.5, 0.5, 0.1})});
}

TEST_CASE("extreme input: the camera in a voxel, on a face, on an edge, in a corner, outside") {
  GaussianCloud cloud;
  for (int i = 0; i < 1000; ++i) {
    add(cloud,
        {0.4F * static_cast<float>(i % 10) - 1.9F, 0.4F * static_cast<float>(i / 10 % 10) - 1.9F,
         0.4F * static_cast<float>(i / 100) - 1.9F},
        kUnitScale, 1, {0.1F * static_cast<float>(i % 10), 0.5F, 0.5F});
  }
  std::vector<Camera> cameras;
  for (const glm::dvec3& position : {glm::dvec3(0.1, 0.13, 0.17),
                                     {0, 0.13, 0.17},
                                     {0, 0.5, 0.17},
                                     {0, 0.5, -0.5},
                                     {0, 0, -20},
                                     {0.1, 0.2, -4}}) {
    cameras.push_back(camera_at(position));  // odd sizes: the middle ray is parallel to z
  }
  // Groups whose ordering tables hold that many voxels.
  check_scene(cloud, cameras,
              settings({"storage.voxel_size=0.5", "group_width_px=32", "group_height_px=32"}));
}

TEST_CASE("extreme input: many layers too faint for one splat to show much") {
  GaussianCloud cloud;
  // Opacity 2/255, which eight bits hold.
  for (int i = 0; i < 4000; ++i) {
    add(cloud, {0, 0, 0.001F * static_cast<float>(i)}, 0, -4.84F, {1, 1, 1});
  }
  const auto views = check_scene(cloud, {camera_at({0, 0, -5}, 16, 16)});
  for (const auto& view : views) CHECK(view["image"]["blends"].get<int>() > 100000);
}

TEST_CASE("extreme input: SH of every degree") {
  for (int degree = 0; degree <= 3; ++degree) {
    GaussianCloud cloud;
    cloud.resize(60, degree);
    for (std::size_t i = 0; i < 60; ++i) {
      const auto at = static_cast<float>(i);
      cloud.means[i] = {0.2F * std::sin(at), 0.2F * std::cos(2 * at), 0.01F * at};
      cloud.log_scales[i] = glm::vec3(-3, -2.5F, -4);
      cloud.quats[i] = {1, 0.3F * std::sin(at), 0.2F, 0};
      cloud.opacity_logits[i] = 1;
    }
    for (std::size_t k = 0; k < cloud.sh_coeffs.size(); ++k) {
      cloud.sh_coeffs[k] = glm::vec3(0.3F * std::sin(static_cast<float>(k)));
    }
    check_scene(cloud, {camera_at({0, 0, -2})});
  }
}

// Two Gaussians in view, and a third whose parameters are what is tested.
GaussianCloud two_and_one() {
  GaussianCloud cloud;
  cloud.resize(3, 3);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto at = static_cast<float>(i);
    cloud.means[i] = {0.3F * at - 0.3F, 0.1F, 5 + at};
    cloud.log_scales[i] = glm::vec3(kUnitScale);
    cloud.quats[i] = {1, 0, 0, 0};
    cloud.sh_coeffs[16 * i] = {1, 0.5F, 0.2F};
  }
  return cloud;
}

struct ExtremeRow {
  const char* what;
  void (*change)(GaussianCloud& cloud);  // of the last Gaussian
  const char* refused = "";              // what is said of it; empty: drawn
};

// Not by both sides' leaving it out: it shows beside the two alone.
TEST_CASE("extreme input: at the limits of every parameter it is drawn, in both orders") {
  const std::vector<Camera> cameras{camera_at({0, 0, 0})};
  GaussianCloud two = two_and_one();
  two.opacity_logits[2] = -20;
  const auto without = check_scene(two, cameras);
  for (const ExtremeRow& row : {
           ExtremeRow{"the largest scale",
                      [](GaussianCloud& c) { c.log_scales[2] = glm::vec3(16.118F); }},
           {"a needle of the largest scale and none",
            [](GaussianCloud& c) {
              c.log_scales[2] = {16.118F, -3e38F, -3e38F};
            }},
           {"a scale of nothing, e^-110",
            [](GaussianCloud& c) { c.log_scales[2] = glm::vec3(-110); }},
           {"an opacity logit of 3e38", [](GaussianCloud& c) { c.opacity_logits[2] = 3e38F; }},
           {"a quaternion of 10^-38",
            [](GaussianCloud& c) {
              c.quats[2] = {1e-38F, 2e-38F, 0, 0};
            }},
           {"a quaternion of 3e38",
            [](GaussianCloud& c) {
              c.quats[2] = {3e38F, 3e38F, -3e38F, 3e38F};
            }},
           {"coefficients of 10^18",
            [](GaussianCloud& c) {
              for (std::size_t k = 32; k < 48; ++k) c.sh_coeffs[k] = {1e18F, -1e18F, 1e18F};
            }},
       }) {
    INFO(row.what);
    GaussianCloud cloud = two_and_one();
    row.change(cloud);
    const auto views = check_scene(cloud, cameras);
    for (std::size_t i = 0; i < views.size(); ++i) {
      CHECK(views[i]["image"]["blends"].get<int>() > without[i]["image"]["blends"].get<int>());
      CHECK(views[i]["image"]["ssim"].is_number());
    }
  }
}

TEST_CASE("extreme input: as far away as can be it is drawn, or its voxels are refused") {
  GaussianCloud cloud = two_and_one();
  cloud.means[2].z = 1e18F;
  cloud.log_scales[2] = glm::vec3(16);
  const Camera camera = camera_at({0, 0, 0});
  GaussianCloud two = cloud;
  two.opacity_logits[2] = -20;
  const auto views = check_machine("exact", cloud, {camera});
  const auto without = check_machine("exact", two, {camera});
  CHECK(views[0]["image"]["blends"].get<int>() > without[0]["image"]["blends"].get<int>());

  // Paper order has no cells for such an extent.
  const ScratchFolder scratch;
  write_ply(scratch.path("scene.ply"), cloud);
  write_cameras(scratch.path("cameras.json"), {camera});
  const Outcome outcome = run_streaminggs({"simulate", scratch.path("scene.ply"), "--cameras",
                                           scratch.path("cameras.json"), "--config", "paper",
                                           "--out", scratch.path("o")});
  INFO(outcome.err);
  CHECK(outcome.status == 2);
  CHECK(outcome.err.find("into more than 2^20 cells an axis") != std::string::npos);
}

TEST_CASE("extreme input: what leaves float is refused by vertex and property, by every command") {
  for (const ExtremeRow& row : {
           ExtremeRow{"scale e^43", [](GaussianCloud& c) { c.log_scales[2].y = 43; },
                      "vertex 2, property scale_1: got 43, expected at most 16.118"},
           {"a depth of 3e38", [](GaussianCloud& c) { c.means[2].z = 3e38F; },
            "vertex 2, property z: got 3e+38, expected a magnitude of at most 1e+18"},
           {"f_dc of -3e38", [](GaussianCloud& c) { c.sh_coeffs[32].x = -3e38F; },
            "vertex 2, property f_dc_0: got -3e+38, expected a magnitude of at most 1e+18"},
           {"f_rest of 3e38", [](GaussianCloud& c) { c.sh_coeffs[47].z = 3e38F; },
            "vertex 2, property f_rest_44: got 3e+38, expected a magnitude of at most 1e+18"},
       }) {
    INFO(row.what);
    const ScratchFolder scratch;
    GaussianCloud cloud = two_and_one();
    row.change(cloud);
    const std::string scene = scratch.path("scene.ply"), cameras = scratch.path("cameras.json");
    write_ply(scene, cloud);
    write_cameras(cameras, {camera_at({0, 0, 0})});
    const std::size_t files = scratch.file_count();
    for (const Arguments& command : std::vector<Arguments>{
             {"simulate", scene, "--cameras", cameras, "--out", scratch.path("o")},
             {"simulate", scene, "--cameras", cameras, "--config", "paper", "--out",
              scratch.path("o")},
             {"render", scene, "--cameras", cameras, "--view", "0", "--out", scratch.path("o.png")},
             {"pack", scene, "--out", scratch.path("o.sgs")},
             {"info", scene}}) {
      INFO(command[0]);
      const Outcome outcome = run_streaminggs(command);
      INFO(outcome.err);
      CHECK(outcome.status == 2);
      CHECK(outcome.err.find(row.refused) != std::string::npos);
      CHECK(scratch.file_count() == files);
    }
  }
}

}  // namespace
}  // namespace sgs::test
