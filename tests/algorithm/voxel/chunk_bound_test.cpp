// The test of a chunk against a pixel group, by brute force on random scenes.
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "algorithm/splat/view.h"
#include "algorithm/voxel/chunk_test.h"
#include "tests/algorithm/voxel/chunk_bound_checks.h"

using namespace sgs;

TEST_CASE("chunk test misses nothing: random hard scenes") { test::fuzz_chunk_bounds(0, 8000); }

TEST_CASE("chunk test misses nothing: of two eyes") {
  test::fuzz_chunk_bounds(100000, 1000, 10);
  test::fuzz_chunk_bounds(200000, 100, 1e5);
}

TEST_CASE("chunk test misses nothing: Gaussians that only just reach a group") {
  CHECK(test::check_bounds_at_the_edge(1, 50000) > 20000);
}

TEST_CASE("nearest depth of a box: its corners are not nearer") {
  test::HardScenes hard(3);
  for (int round = 0; round < 20000; ++round) {
    const test::HardScene scene = hard.next(1, 100);
    const View<float> view = make_view<float>(scene.camera);
    const glm::vec3 from = scene.cloud.means[0];
    const auto size = static_cast<float>(std::exp(hard.uniform(-8, 8)));
    const glm::vec3 to = from + size * glm::vec3(glm::dvec3(hard.uniform(0, 1), hard.uniform(0, 1),
                                                            hard.uniform(0, 1)));
    ChunkBound bound;
    bound.low = from;
    bound.high = to;
    bound.extent = glm::vec3(std::numeric_limits<float>::infinity());
    bound.scale_max = 1e30F;
    const ChunkTest test = GroupFrustum(view, {0, 0, view.width, view.height}).test(bound);
    for (int corner = 0; corner < 8; ++corner) {
      const glm::vec3 p((corner & 1) != 0 ? to.x : from.x, (corner & 2) != 0 ? to.y : from.y,
                        (corner & 4) != 0 ? to.z : from.z);
      const float depth = to_camera(view, p).z;
      if (!(depth > 0.2F)) continue;
      REQUIRE(test.touches);
      REQUIRE(test.nearest <= depth);
    }
  }
}

TEST_CASE("nearest depth of a box: corners that only the slack for rounding keeps behind it") {
  // Found by a search for the least distance between the two; without the slack of the depth in
  // chunk_tree.cpp the box is said to begin one to four steps of float behind its corner.
  struct Case {
    glm::vec3 forward, low, high;
  };
  for (const Case& c : {Case{{0.982878864F, 0.172371909F, 0.0650927052F},
                             {4.24021578F, -0.32074365F, -0.72333312F},
                             {4.30274677F, -0.22496143F, 0.281292558F}},
                        Case{{0.9966892F, 0.0499038175F, 0.0641895831F},
                             {4.26407242F, 2.17053723F, 1.82941651F},
                             {4.29803228F, 2.17053723F, 2.70328474F}},
                        Case{{0.161955684F, 0.981333733F, 0.103703797F},
                             {0.0684398338F, 0.525289118F, 7.31179e-07F},
                             {0.0727311894F, 0.640138507F, 1.00414684e-06F}}}) {
    CAPTURE(c.low.x);
    const glm::dvec3 forward(c.forward);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0, 0, 1)));
    Camera camera;
    camera.width = camera.height = 100;
    camera.focal_x = camera.focal_y = 50;
    camera.world_from_camera = glm::dmat3(right, glm::cross(forward, right), forward);
    const View<float> view = make_view<float>(camera);
    ChunkBound bound;
    bound.low = c.low;
    bound.high = c.high;
    bound.extent = glm::vec3(100);
    bound.scale_max = 30;
    const ChunkTest test = GroupFrustum(view, {0, 0, 100, 100}).test(bound);
    CHECK(test.touches);
    CHECK(test.nearest <= to_camera(view, c.low).z);
    CHECK(test.nearest == Approx(to_camera(view, c.low).z).epsilon(1e-5));
  }
}

TEST_CASE("chunk test misses nothing: coordinates near the end of float") {
  for (const float far : {1e18F, 1e30F, 1e36F, 3e38F}) {
    CAPTURE(far);
    test::BoundTally tally;
    for (unsigned seed = 0; seed < 100; ++seed) {
      test::HardScenes hard(seed);
      test::HardScene scene = hard.next(60, 64);
      for (auto& mean : scene.cloud.means) {
        if (hard.pick(3) != 0) continue;
        for (int k = 0; k < 3; ++k) mean[k] = far * static_cast<float>(hard.uniform(-1, 1));
      }
      for (auto& scale : scene.cloud.log_scales) {
        if (hard.pick(5) == 0) scale = glm::vec3(std::log(far * 0.1F));
      }
      test::check_chunk_bounds(scene, 1 + seed % 16, square_of(16), tally);
      if (!tally.failure.empty()) FAIL("seed " << seed << ": " << tally.failure);
    }
    CHECK(tally.chunks > 1000);
  }
}
