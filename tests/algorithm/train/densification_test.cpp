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

TEST_CASE("densification: once opacities were reset, too large ones go") {
  Scene scene;
  add_ball(scene.cloud, {0, 0, 3}, 0.5, 0.5, {1, 0, 0});
  add_ball(scene.cloud, {0, 0, 3}, 1.5, 0.5, {1, 0, 0});
  scene.pulls = {{0, 0}, {0, 0}};
  Adam adam(scene.cloud);
  densify_and_prune({}, seen(scene, 1), kExtent, false, 9, 1, 0, scene.cloud, adam);
  CHECK(scene.cloud.size() == 2);
  densify_and_prune({}, seen(scene, 1), kExtent, true, 9, 1, 0, scene.cloud, adam);
  CHECK(scene.cloud.size() == 1);
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
