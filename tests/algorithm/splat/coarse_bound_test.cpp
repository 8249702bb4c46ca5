// Tests of algorithm/splat/coarse_bound.h: the cases where it is tight.
#include "algorithm/splat/coarse_bound.h"

#include <catch2/catch.hpp>

#include "tests/algorithm/splat/camera_at_origin.h"

using namespace sgs;

namespace {

using test::camera_at_origin;

Gaussian<float> ball(glm::vec3 mean, float radius) {
  return {mean, glm::vec3(radius), {1, 0, 0, 0}, 1.0F};
}

}  // namespace

TEST_CASE("the square holds the tiles of every round splat, whose radius has an extra 0.1") {
  const auto view = make_view<float>(camera_at_origin());
  for (int i = 0; i < 20000; ++i) {
    const auto g = ball({0, 0, 4}, 0.02F + 0.0002F * static_cast<float>(i));
    const auto bound = coarse_bound(view, g.mean, g.scale.x);
    const auto p = project(view, g, to_camera(view, g.mean));
    // The first pixel of the first tile lies less than 16 px before centre - radius.
    REQUIRE(bound.square_px >= p.radius + 16);
  }
}

TEST_CASE("a rotation that stretches by a thousandth stretches the bound") {
  Camera camera = camera_at_origin();
  camera.world_from_camera[0].x = 1.001;
  const auto view = make_view<float>(camera);
  for (const float radius : {2.4F, 24.0F, 240.0F}) {
    const auto g = ball({0, 0, 4}, radius);
    const auto bound = coarse_bound(view, g.mean, radius);
    const auto p = project(view, g, to_camera(view, g.mean));
    CHECK(bound.square_px >= p.radius + 16);
    CHECK(bound.reach_px >= constant<float>(kVisibleSigmas) * std::sqrt(p.cov_a));
  }
}

TEST_CASE("a splat wider than the bound on rounding reaches everything in its square") {
  const auto view = make_view<float>(camera_at_origin());
  const auto bound = coarse_bound(view, {0, 0, 4}, 1000.0F);
  CHECK(touches(bound, {0, 0, 100, 50}));
  CHECK(bound.reach_px > 1e30F);
}
