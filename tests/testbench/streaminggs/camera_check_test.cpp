// Which cameras are doubted.
#include "testbench/streaminggs/run/camera_check.h"

#include <catch2/catch.hpp>

#include "algorithm/splat/activate.h"
#include "testbench/builtin/builtin_scene.h"

namespace sgs::test {
namespace {

using Catch::Matchers::Contains;

Gaussian<float> gaussian_at(float x, float y, float z) {
  return {{x, y, z}, {1, 1, 1}, {1, 0, 0, 0}, 0.5F};
}

// At the origin, looking along z; a frame of 8x4 px that is as wide at depth 1 as 2x1.
Camera small_camera() {
  Camera camera;
  camera.width = 8;
  camera.height = 4;
  camera.focal_x = camera.focal_y = 4;
  return camera;
}

TEST_CASE("camera check: a share is that of the centres before the camera and within its frame") {
  ActivatedCloud cloud;
  for (const auto& [x, y, z] : std::vector<std::array<float, 3>>{{0, 0, 1},
                                                                 {0.99F, 0.49F, 1},
                                                                 {1.98F, -0.98F, 2},
                                                                 {1.01F, 0, 1},
                                                                 {0, 0.51F, 1},
                                                                 {0, 0, -1},
                                                                 {-0.99F, -0.49F, -1},
                                                                 {0, 0, 0}}) {
    cloud.gaussians.push_back(gaussian_at(x, y, z));
  }
  Camera camera = small_camera();
  CHECK(share_in_frame(cloud, camera) == 3.0 / 8);
  // With its principal point 1 px from the left border it sees as far to the right as 1.75.
  camera.principal_offset = {-3, 0};
  CHECK(share_in_frame(cloud, camera) == 4.0 / 8);
  camera.principal_offset = {3, 1};
  CHECK(share_in_frame(cloud, camera) == 1.0 / 8);
  camera.principal_offset = {0, 0};
  // Moved and turned with the scene, it sees the same.
  camera.position = {5, -3, 2};
  camera.world_from_camera = {{0, 0, -1}, {0, 1, 0}, {1, 0, 0}};
  for (Gaussian<float>& gaussian : cloud.gaussians) {
    gaussian.mean =
        glm::vec3(camera.world_from_camera * glm::dvec3(gaussian.mean) + camera.position);
  }
  CHECK(share_in_frame(cloud, camera) == 3.0 / 8);
}

TEST_CASE("camera check: a scene's own cameras pass") {
  for (const char* spec :
       {"builtin:capture?n=5000", "builtin:object?n=5000", "builtin:outdoor?n=5000"}) {
    const BuiltinScene scene = make_builtin_scene(spec);
    const ActivatedCloud cloud = activate(scene.cloud);
    for (const Camera& camera : scene.cameras) {
      INFO(spec << " camera " << camera.id);
      CHECK(doubt_about(camera, cloud).empty());
      CHECK(share_in_frame(cloud, camera) > 10 * kLeastShareInFrame);
    }
  }
}

TEST_CASE("camera check: cameras around an object are doubted with axes up and backward") {
  const BuiltinScene scene = make_builtin_scene("builtin:object?n=5000");
  const ActivatedCloud cloud = activate(scene.cloud);
  for (Camera camera : scene.cameras) {
    INFO("camera " << camera.id);
    camera.world_from_camera[1] *= -1;
    camera.world_from_camera[2] *= -1;
    CHECK_THAT(doubt_about(camera, cloud),
               Contains("% of the Gaussians lie in the frame") && !Contains("Expected"));
    camera.axes = "from there to here";
    CHECK_THAT(doubt_about(camera, cloud),
               Contains(" Expected poses from there to here, in the scene's coordinates"));
  }
}

TEST_CASE("camera check: the limit, and a scene of nothing") {
  ActivatedCloud cloud;
  CHECK(doubt_about(small_camera(), cloud).empty());
  cloud.gaussians.assign(1000, gaussian_at(0, 0, -1));
  for (int seen = 0; seen < 5; ++seen) {
    INFO(seen);
    CHECK_THAT(doubt_about(small_camera(), cloud),
               Contains("0." + std::to_string(seen) + "0 % of"));
    cloud.gaussians[static_cast<std::size_t>(seen)] = gaussian_at(0, 0, 1);
  }
  CHECK(doubt_about(small_camera(), cloud).empty());
}

}  // namespace
}  // namespace sgs::test
