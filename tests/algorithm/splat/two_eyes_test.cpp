// Tests of two eyes (view.h): one depth for both, and the right one sees what a camera that stands
// there sees.
#include <catch2/catch.hpp>

#include "algorithm/splat/coarse_bound.h"
#include "algorithm/splat/make_splat.h"
#include "tests/algorithm/splat/random_gaussian.h"

using namespace sgs;

namespace {

constexpr int kRounds = 20000;

// Calls visit(left, right, camera, Gaussian) for cameras and Gaussians of every kind.
template <class Visit>
void for_random_eyes(unsigned seed, const Visit& visit) {
  test::RandomGaussians random(seed, 200, 120);
  for (int round = 0; round < kRounds; ++round) {
    Camera camera = random.camera();
    camera.eyes_apart = random.log_uniform(1e-4, 10);
    const View<float> left = make_view<float>(camera);
    visit(left, right_eye(left), camera, random.gaussian(camera));
  }
}

}  // namespace

TEST_CASE("two eyes: depth and height are the same to the bit, beside them one subtraction") {
  for_random_eyes(1, [](const View<float>& left, const View<float>& right, const Camera& camera,
                        const Gaussian<float>& g) {
    const glm::vec3 l = to_camera(left, g.mean), r = to_camera(right, g.mean);
    REQUIRE(l.z == r.z);
    REQUIRE(l.y == r.y);
    REQUIRE(r.x == l.x - static_cast<float>(camera.eyes_apart));
  });
}

TEST_CASE("two eyes: the right one is a camera that stands there") {
  for_random_eyes(2, [](const View<float>& left, const View<float>& right, const Camera& camera,
                        const Gaussian<float>& g) {
    Camera moved = camera;
    moved.position += camera.eyes_apart * camera.world_from_camera[0];
    moved.eyes_apart = 0;
    const glm::vec3 there = to_camera(make_view<float>(moved), g.mean);
    const glm::vec3 r = to_camera(right, g.mean);
    const float size = glm::length(to_camera(left, g.mean)) + static_cast<float>(camera.eyes_apart);
    REQUIRE(glm::length(r - there) <= 1e-5F * size);
    REQUIRE(glm::length(sight(right, g.mean) - sight(make_view<float>(moved), g.mean)) <=
            1e-5F * size);
    REQUIRE(sight(left, g.mean) == from_eye(left, g.mean));
  });
}

TEST_CASE("two eyes: what is culled for both is on neither picture") {
  int culled = 0, seen_by_right_alone = 0;
  for_random_eyes(3, [&](const View<float>& left, const View<float>& right, const Camera&,
                         const Gaussian<float>& g) {
    const float largest = std::max({g.scale.x, g.scale.y, g.scale.z});
    const bool kept = may_touch_frame(left, frame_sides(left), g.mean, largest);
    Splat splat{};
    const bool in_left = make_geometry(left, g, splat), in_right = make_geometry(right, g, splat);
    REQUIRE((kept || !(in_left || in_right)));
    culled += kept ? 0 : 1;
    seen_by_right_alone += in_right && !in_left ? 1 : 0;
  });
  CHECK(culled > kRounds / 100);
  CHECK(seen_by_right_alone > kRounds / 200);
}
