// Random steps of faint Gaussians, against the formula of 3DGS as MCMC (Kheradmand et al. 2024):
// rate 5e5 sigmoid(100 (0.005 - opacity)) Sigma xi.
#include "algorithm/train/position_noise.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <utility>
#include <vector>

#include "algorithm/splat/activate.h"
#include "tests/algorithm/render/test_clouds.h"

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
