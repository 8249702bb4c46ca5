// Tests of algorithm/splat/coarse_bound.h: values by hand, and the cases where it is tight.
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

TEST_CASE("coarse bound by hand") {
  // v = (1, 0.5, 4): u = 0.25, w = 0.125; lambda = (100*0.3/4)^2 (1 + 0.0625 + 0.015625) + 0.3.
  const auto bound = coarse_bound(make_view<float>(camera_at_origin()), {1, 0.5F, 4}, 0.3F);
  const double lambda = 56.25 * 1.078125 + 0.3, sigma = std::sqrt(lambda);
  CHECK(bound.in_front);
  CHECK(bound.depth == 4);
  CHECK(bound.x == 74.5F);
  CHECK(bound.y == 34.5F);
  CHECK(bound.reach_px >= 3.329043 * sigma);
  const double widening = 64 * 0x1p-24 * 4 / 0.3 * lambda;
  CHECK(bound.reach_px < 3.329043 * sigma * (1.0003 + widening) + 0.06);
  CHECK(bound.square_px >= 3 * std::sqrt(lambda + 0.3162) + 17);
  CHECK(bound.square_px < 3 * std::sqrt(lambda + 0.3164) + 17.001);
}

TEST_CASE("coarse bound: on and behind the near plane nothing is in front") {
  const auto view = make_view<float>(camera_at_origin());
  CHECK_FALSE(coarse_bound(view, {0, 0, 0.2F}, 1.0F).in_front);
  CHECK_FALSE(coarse_bound(view, {0, 0, -4}, 1.0F).in_front);
  CHECK_FALSE(coarse_bound(view, {0, 0, 0}, 1.0F).in_front);
  CHECK(coarse_bound(view, {0, 0, std::nextafter(0.2F, 1.0F)}, 1.0F).in_front);
}

TEST_CASE("touches: circle and square against a rectangle of pixels") {
  CoarseBound bound{true, 1, 10, 20, 5, 100};
  CHECK(touches(bound, {13, 24, 20, 30}));  // corner (13, 24) at distance 5
  CHECK_FALSE(touches(bound, {14, 24, 20, 30}));
  CHECK(touches(bound, {0, 0, 11, 21}));  // last pixel is the centre itself
  CHECK(touches(bound, {0, 0, 8, 17}));   // pixel (7, 16): distance 5
  CHECK_FALSE(touches(bound, {0, 0, 7, 17}));
  bound.square_px = 3;
  CHECK_FALSE(touches(bound, {13, 24, 20, 30}));
  CHECK(touches(bound, {13, 23, 20, 30}));
}

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
