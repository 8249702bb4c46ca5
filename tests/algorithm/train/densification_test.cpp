// The original's rules, on Gaussians that each fall under one of them.
#include "algorithm/train/densification.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "algorithm/splat/activate.h"
#include "tests/algorithm/render/test_clouds.h"

namespace sgs::test {
namespace {

constexpr double kExtent = 10;  // small up to 0.1, large from 1

struct Scene {
  GaussianCloud cloud;
  std::vector<glm::vec2> pulls;  // 1/px
};

// Steps in which all are seen with these pulls.
DensificationStatistics seen(const Scene& scene, int steps) {
  DensificationStatistics out(scene.cloud.size());
  GroupSequences sequences;
  sequences.width = 200;
  sequences.height = 100;
  CloudGradient gradient;
  gradient.resize(scene.cloud.size(), 0);
  for (std::uint32_t i = 0; i < scene.cloud.size(); ++i) gradient.indices[i] = i;
  gradient.centres = scene.pulls;
  for (int step = 0; step < steps; ++step) out.add(sequences, gradient);
  return out;
}

Scene three_kinds() {
  Scene out;
  add_ball(out.cloud, {0, 0, 3}, 0.05, 0.5, {1, 0, 0});    // small, pulled: cloned
  add_ball(out.cloud, {1, 0, 3}, 0.5, 0.5, {0, 1, 0});     // large, pulled: split
  add_ball(out.cloud, {2, 0, 3}, 0.05, 0.5, {0, 0, 1});    // not pulled
  add_ball(out.cloud, {3, 0, 3}, 0.05, 0.004, {1, 1, 1});  // faint: goes
  out.pulls = {{1e-5F, 0}, {0, 1e-5F}, {1e-7F, 0}, {1e-5F, 0}};
  return out;
}

TEST_CASE("densification: pulls are means in half screens") {
  const Scene scene = three_kinds();
  const DensificationStatistics of = seen(scene, 3);
  CHECK(of.pull(0) == Approx(1e-5 * 100));
  CHECK(of.pull(1) == Approx(1e-5 * 50));
}

TEST_CASE("densification: small ones are cloned, large ones split, faint ones go") {
  Scene scene = three_kinds();
  Adam adam(scene.cloud);
  densify_and_prune({}, seen(scene, 2), kExtent, false, 100, 1, 100, scene.cloud, adam);
  const GaussianCloud& cloud = scene.cloud;
  REQUIRE(cloud.size() == 5);
  CHECK(cloud.means[0].x == 0);
  CHECK(cloud.means[1].x == 2);
  CHECK(cloud.means[2].x == 0);
  for (const std::size_t half : {3U, 4U}) {
    CHECK(std::exp(cloud.log_scales[half].x) == Approx(0.5 / 1.6));
    CHECK(glm::distance(cloud.means[half], glm::vec3(1, 0, 3)) < 3);
  }
  CHECK(cloud.means[3] != cloud.means[4]);
  CHECK(adam.moments().updates.size() == 5);
}

TEST_CASE("densification: room goes to those that are pulled most") {
  Scene scene = three_kinds();
  Adam adam(scene.cloud);
  densify_and_prune({}, seen(scene, 2), kExtent, false, 4, 1, 100, scene.cloud, adam);
  REQUIRE(scene.cloud.size() == 4);
  CHECK(scene.cloud.means[3].x == 0);
}

// How many are left of one Gaussian: none, itself, or two.
std::size_t left_of(double radius, double opacity, float pull_x, bool prune_large = false) {
  Scene scene;
  add_ball(scene.cloud, {0, 0, 3}, radius, opacity, {1, 0, 0});
  scene.pulls = {{pull_x, 0}};
  Adam adam(scene.cloud);
  densify_and_prune({}, seen(scene, 1), kExtent, prune_large, 9, 1, 0, scene.cloud, adam);
  return scene.cloud.size();
}

// The original's, from just beside them (Kerbl et al. 2023, released code): densify_grad_threshold
// 2e-4, opacities 5e-3, a tenth of the extent.
TEST_CASE("densification: thresholds") {
  CHECK(left_of(0.05, 0.0049, 0) == 0);
  CHECK(left_of(0.05, 0.0051, 0) == 1);
  // 100 px are half a screen.
  CHECK(left_of(0.05, 0.5, 1.9e-6F) == 1);
  CHECK(left_of(0.05, 0.5, 2.1e-6F) == 2);
  CHECK(left_of(0.099 * kExtent, 0.5, 0, true) == 1);
  CHECK(left_of(0.101 * kExtent, 0.5, 0, true) == 0);
}

// percent_dense, 0.01 of the extent: a clone is where it was, what is split is not.
TEST_CASE("densification: up to a hundredth of the extent cloned, above it split") {
  for (const double share : {0.0099, 0.0101}) {
    CAPTURE(share);
    Scene scene;
    add_ball(scene.cloud, {0, 0, 3}, share * kExtent, 0.5, {1, 0, 0});
    scene.pulls = {{1e-5F, 0}};
    Adam adam(scene.cloud);
    densify_and_prune({}, seen(scene, 1), kExtent, false, 9, 1, 0, scene.cloud, adam);
    REQUIRE(scene.cloud.size() == 2);
    CHECK((scene.cloud.means[0] == glm::vec3(0, 0, 3)) == (share < 0.01));
    CHECK(std::exp(scene.cloud.log_scales[0].x) ==
          Approx(share * kExtent / (share < 0.01 ? 1 : 1.6)));
  }
}

// A needle across the view's middle, `sigma_px` long there, turned by an eighth: with the 0.3 px^2
// that every splat gets, three deviations are 3 sqrt(sigma^2 + 0.3).
GroupSequences picture_of_needle(double sigma_px, GaussianCloud& cloud) {
  constexpr double kFocalPx = 100, kDepth = 4;
  cloud = {};
  add_ball(cloud, {0, 0, kDepth}, sigma_px * kDepth / kFocalPx, 0.5, {1, 1, 1});
  cloud.log_scales[0].y -= 3;
  cloud.log_scales[0].z -= 3;
  constexpr double kSixteenth = 0.39269908169872414;
  cloud.quats[0] = {static_cast<float>(std::cos(kSixteenth)), 0, 0,
                    static_cast<float>(std::sin(kSixteenth))};
  return reference_sequences(make_view<float>(forward_camera(200, 100, kFocalPx)), activate(cloud));
}

TEST_CASE("densification: the radius on the screen is the largest that was seen") {
  GaussianCloud cloud;
  DensificationStatistics of(1);
  CHECK(of.radius_px(0) == 0);
  double largest = 0;
  for (const double sigma : {2.0, 6.0, 3.0}) {
    of.add(picture_of_needle(sigma, cloud), {});
    largest = std::max(largest, sigma);
    CHECK(of.radius_px(0) == Approx(3 * std::sqrt(largest * largest + 0.3)));
  }
  CHECK(of.pull(0) == 0);
}

TEST_CASE("densification: once opacities were reset, 20 px on the screen are too many") {
  for (const double radius_px : {19.9, 20.1}) {
    for (const bool was_reset : {false, true}) {
      CAPTURE(radius_px, was_reset);
      GaussianCloud cloud;
      DensificationStatistics of(1);
      of.add(picture_of_needle(std::sqrt(radius_px * radius_px / 9 - 0.3), cloud), {});
      CHECK(of.radius_px(0) == Approx(radius_px));
      Adam adam(cloud);
      densify_and_prune({}, of, kExtent, was_reset, 9, 1, 0, cloud, adam);
      CHECK(cloud.size() == (was_reset && radius_px > 20 ? 0U : 1U));
    }
  }
}

TEST_CASE("densification: opacities are reset downward only") {
  GaussianCloud cloud;
  add_ball(cloud, {0, 0, 3}, 1, 0.9, {1, 0, 0});
  add_ball(cloud, {0, 0, 3}, 1, 0.002, {1, 0, 0});
  Adam adam(cloud);
  AdamMoments moments = adam.moments();
  std::fill(moments.values.begin(), moments.values.end(), 1.0F);
  adam.restore(moments);
  const float faint = cloud.opacity_logits[1];
  reset_opacities({}, cloud, adam);
  // A first and a second moment of each.
  const std::vector<float>& left = adam.moments().values;
  CHECK(std::count(left.begin(), left.end(), 0.0F) == 4);
  CHECK(1 / (1 + std::exp(-cloud.opacity_logits[0])) == Approx(0.01));
  CHECK(cloud.opacity_logits[1] == faint);
}

}  // namespace
}  // namespace sgs::test
