// Shares of Gaussians look like what they were shares of.
#include "algorithm/train/mcmc.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <utility>
#include <vector>

#include "algorithm/image/quality.h"
#include "algorithm/splat/activate.h"
#include "algorithm/tune/group_sequences.h"
#include "tests/algorithm/render/test_clouds.h"

namespace sgs::test {
namespace {

double opacity_of(float logit) { return 1 / (1 + std::exp(-static_cast<double>(logit))); }

Image picture_of(const GaussianCloud& cloud) {
  const auto view = make_view<float>(forward_camera(96, 64, 80));
  return draw(reference_sequences(view, activate(cloud))).image;
}

TEST_CASE("relocation: shares compose to the opacity that they are shares of") {
  for (const double opacity : {0.006, 0.1, 0.5, 0.9, 0.999, 0.999999}) {
    for (const int count : {1, 2, 3, 10, 51}) {
      CAPTURE(opacity, count);
      const Division share = divided(opacity, count);
      CHECK(1 - std::pow(1 - share.opacity, count) == Approx(opacity).epsilon(1e-9));
      CHECK(std::isfinite(share.scale_factor));
      CHECK(share.scale_factor > 0);
    }
  }
  CHECK(divided(0.7, 1).scale_factor == Approx(1).epsilon(1e-12));
  CHECK(divided(0.7, 80).opacity == divided(0.7, 51).opacity);
}

// Equation 9 keeps the integral along a line: that of o exp(-x^2 / 2 s^2) is that of the light that
// n shares take of each other.
TEST_CASE("relocation: the integral of what shares take is kept") {
  for (const double opacity : {0.2, 0.6, 0.95}) {
    for (const int count : {2, 3, 5}) {
      CAPTURE(opacity, count);
      const Division share = divided(opacity, count);
      double one = 0, all = 0;
      for (double x = -12; x < 12; x += 1e-3) {
        one += opacity * std::exp(-x * x / 2);
        const double s = share.scale_factor;
        all += 1 - std::pow(1 - share.opacity * std::exp(-x * x / (2 * s * s)), count);
      }
      CHECK(all == Approx(one).epsilon(1e-6));
    }
  }
}

TEST_CASE("relocation: dead Gaussians go to living ones, whose moments begin anew") {
  GaussianCloud cloud;
  for (int i = 0; i < 6; ++i) {
    const bool dead = i % 2 == 0;
    add_ball(cloud, {0.1F * static_cast<float>(i), 0, 3}, 0.1, dead ? 0.004 : 0.3, {0.5F, 0, 1});
  }
  Adam adam(cloud);
  AdamMoments moments = adam.moments();
  for (auto& updates : moments.updates) updates = 5;
  adam.restore(moments);
  const GaussianCloud before = cloud;
  CHECK(relocate_dead(cloud, adam, 1, 10) == 3);
  REQUIRE(cloud.size() == 6);
  int divided_ones = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    CHECK(opacity_of(cloud.opacity_logits[i]) > kDeadOpacity);
    if (i % 2 == 0) {
      const auto at = std::find(before.means.begin(), before.means.end(), cloud.means[i]);
      REQUIRE(at != before.means.end());
      CHECK((at - before.means.begin()) % 2 == 1);
      CHECK(adam.moments().updates[i] == 0);
    } else {
      CHECK(cloud.means[i] == before.means[i]);
      const bool is_divided = cloud.opacity_logits[i] != before.opacity_logits[i];
      CHECK(adam.moments().updates[i] == (is_divided ? 0U : 5U));
      divided_ones += is_divided ? 1 : 0;
    }
  }
  CHECK(divided_ones >= 1);
  CHECK(relocate_dead(cloud, adam, 1, 11) == 0);
}

TEST_CASE("relocation: nothing is moved where all are dead") {
  GaussianCloud cloud;
  for (int i = 0; i < 3; ++i) add_ball(cloud, {0, 0, 3}, 0.1, 0.003, {1, 1, 1});
  Adam adam(cloud);
  CHECK(relocate_dead(cloud, adam, 1, 0) == 0);
  add_shares(2, cloud, adam, 1, 0);
  CHECK(cloud.size() == 3);
}

TEST_CASE("relocation: a third more Gaussians show nearly the same picture") {
  GaussianCloud cloud = random_cloud(4, 300, 1, {0, 0, 3}, 1, 0.03F, 0.3F);
  const Image before = picture_of(cloud);
  Adam adam(cloud);
  add_shares(100, cloud, adam, 3, 500);
  REQUIRE(cloud.size() == 400);
  REQUIRE(adam.moments().updates.size() == 400);
  CHECK(psnr_db(before, picture_of(cloud)) > 30);
}

}  // namespace
}  // namespace sgs::test

namespace sgs::test {
namespace {

constexpr double kFactor = 3;
const glm::vec3 kScales(0.2F, 0.1F, 0.05F);

// All at the origin, turned by an eighth about z.
GaussianCloud eighth_turned(std::size_t count, double opacity) {
  GaussianCloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    add_ball(cloud, glm::vec3(0), 1, opacity, {1, 1, 1});
    cloud.log_scales.back() = glm::log(kScales);
    constexpr double kSixteenth = 0.39269908169872414;
    cloud.quats.back() = {static_cast<float>(std::cos(kSixteenth)), 0, 0,
                          static_cast<float>(std::sin(kSixteenth))};
  }
  return cloud;
}

std::vector<std::uint32_t> add_noise(GaussianCloud& cloud, std::uint64_t seed = 1,
                                     std::uint64_t step = 2) {
  return add_position_noise(cloud, activate(cloud), kFactor, seed, step);
}

// Where opacity is 0.005 the sigmoid is a half, and Sigma is the squared scale along each axis.
TEST_CASE("position noise: along each axis half its squared scale, around 0") {
  constexpr std::size_t kCount = 20'000;
  GaussianCloud cloud = eighth_turned(kCount, 0.005);
  CHECK(add_noise(cloud).size() == kCount);
  const glm::dvec3 axes[] = {
      glm::normalize(glm::dvec3(1, 1, 0)), glm::normalize(glm::dvec3(-1, 1, 0)), {0, 0, 1}};
  std::array<double, 3> sigma{}, sum{};
  std::array<std::array<double, 3>, 3> products{};
  for (const glm::vec3& mean : cloud.means) {
    for (int a = 0; a < 3; ++a) {
      sum[a] += glm::dot(glm::dvec3(mean), axes[a]);
      for (int b = 0; b < 3; ++b) {
        products[a][b] += glm::dot(glm::dvec3(mean), axes[a]) * glm::dot(glm::dvec3(mean), axes[b]);
      }
    }
  }
  for (int a = 0; a < 3; ++a) sigma[a] = kFactor * 0.5 * kScales[a] * kScales[a];
  // Five deviations of what is drawn of so many: 1 / sqrt(2 n) of a deviation, 1 / sqrt(n) of a
  // mean and of a correlation.
  const double root = std::sqrt(static_cast<double>(kCount));
  for (int a = 0; a < 3; ++a) {
    CAPTURE(a);
    CHECK(std::sqrt(products[a][a] / kCount) ==
          Approx(sigma[a]).epsilon(5 / (root * std::sqrt(2.0))));
    CHECK(std::abs(sum[a] / kCount) < 5 * sigma[a] / root);
    for (int b = 0; b < a; ++b) {
      CHECK(std::abs(products[a][b] / kCount) < 5 * sigma[a] * sigma[b] / root);
    }
  }
}

// Of one seed, step and place the normal numbers are the same, so that steps differ by the sigmoid
// alone: a half at 0.005, 1 / (1 + e^4.5) = 0.01099 at 0.05, 1 / (1 + e^-0.4) = 0.5987 at 0.001.
TEST_CASE("position noise: its share falls with opacity") {
  GaussianCloud half = eighth_turned(20, 0.005);
  add_noise(half);
  for (const auto& [opacity, share] : {std::pair{0.001, 0.598688}, {0.05, 0.0109869}}) {
    CAPTURE(opacity);
    GaussianCloud cloud = eighth_turned(20, opacity);
    CHECK(add_noise(cloud).size() == 20);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      // Opacities are floats: 100 times one is off by 6e-7.
      CHECK(glm::length(cloud.means[i]) / glm::length(half.means[i]) ==
            Approx(share / 0.5).epsilon(1e-5));
    }
  }
}

TEST_CASE("position noise: opacities above a quarter stay") {
  GaussianCloud cloud = eighth_turned(1, 0.26);
  for (const double opacity : {0.24, 0.9, 0.004}) {
    const GaussianCloud one = eighth_turned(1, opacity);
    add_ball(cloud, one.means[0], 1, opacity, {1, 1, 1});
  }
  CHECK(add_noise(cloud) == std::vector<std::uint32_t>{1, 3});
  CHECK(cloud.means[0] == glm::vec3(0));
  CHECK(cloud.means[2] == glm::vec3(0));
  CHECK(cloud.means[3] != glm::vec3(0));
}

TEST_CASE("position noise: other numbers for each seed, step and Gaussian") {
  GaussianCloud first = eighth_turned(2, 0.005), again = first, seed = first, step = first;
  add_noise(first, 1, 2);
  add_noise(again, 1, 2);
  add_noise(seed, 2, 2);
  add_noise(step, 1, 3);
  CHECK(first.means == again.means);
  CHECK(first.means[0] != first.means[1]);
  CHECK(first.means[0] != seed.means[0]);
  CHECK(first.means[0] != step.means[0]);
}

}  // namespace
}  // namespace sgs::test
