// Tests of algorithm/splat/activate.h.
#include "algorithm/splat/activate.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "algorithm/splat/counting.h"
#include "tests/algorithm/render/test_clouds.h"
#include "tests/algorithm/splat/dual.h"

using namespace sgs;
using test::Dual;

namespace {

// The 11 parameters in the order of a record, in any scalar.
template <class T, class Make>
RawGaussian<T> raw_of(const std::array<double, 11>& p, const Make& make) {
  const auto at = [&](std::size_t k) { return make(p[k], k); };
  return {{at(0), at(1), at(2)}, {at(3), at(4), at(5)}, {at(6), at(7), at(8), at(9)}, at(10)};
}
template <class T>
std::array<T, 11> values_of(const Gaussian<T>& g) {
  return {g.mean.x,  g.mean.y,  g.mean.z,  g.scale.x, g.scale.y, g.scale.z,
          g.quat[0], g.quat[1], g.quat[2], g.quat[3], g.opacity};
}

// Numbers that float holds exactly.
std::array<double, 11> random_parameters(std::mt19937& random) {
  std::normal_distribution<double> normal;
  std::array<double, 11> p{};
  for (double& value : p) value = 0x1p-16 * std::round(0x1p17 * normal(random));
  return p;
}

std::array<double, 11> in_double(const std::array<double, 11>& p) {
  return values_of(activate(raw_of<double>(p, [](double v, std::size_t) { return v; })));
}

}  // namespace

TEST_CASE("activation in float is the one in double, rounded once") {
  std::mt19937 random(1);
  for (int round = 0; round < 2000; ++round) {
    const std::array<double, 11> p = random_parameters(random);
    const auto narrow =
        values_of(activate(raw_of<float>(p, [](double v, std::size_t) { return float(v); })));
    const auto wide = in_double(p);
    for (std::size_t k = 0; k < p.size(); ++k) REQUIRE(narrow[k] == static_cast<float>(wide[k]));
  }
}

TEST_CASE("activation of dual numbers carries the derivatives") {
  std::mt19937 random(2);
  for (int round = 0; round < 200; ++round) {
    const std::array<double, 11> p = random_parameters(random);
    for (std::size_t along = 0; along < p.size(); ++along) {
      const auto dual = values_of(activate(
          raw_of<Dual>(p, [&](double v, std::size_t k) { return Dual(v, k == along ? 1 : 0); })));
      constexpr double kStep = 1e-5;
      std::array<double, 11> low = p, high = p;
      low[along] -= kStep;
      high[along] += kStep;
      const auto below = in_double(low), above = in_double(high);
      for (std::size_t k = 0; k < p.size(); ++k) {
        const double expected = (above[k] - below[k]) / (2 * kStep);
        CAPTURE(round, along, k);
        REQUIRE(dual[k].slope == Approx(expected).epsilon(1e-5).margin(1e-6));
      }
    }
  }
}

TEST_CASE("activating again what has changed is activating all") {
  for (const int degree : {0, 3}) {
    GaussianCloud cloud = test::random_cloud(1, 50, degree, {0, 0, 0}, 1, 0.01F, 0.5F);
    ActivatedCloud activated = activate(cloud);
    const std::vector<std::uint32_t> indices{0, 3, 17, 49};
    const auto coeffs = static_cast<std::size_t>(sh_coeff_count(degree));
    for (const std::uint32_t i : indices) {
      cloud.means[i] += 1.0F;
      cloud.log_scales[i] += 0.5F;
      cloud.quats[i][1] += 2.0F;
      cloud.opacity_logits[i] -= 1.0F;
      cloud.sh_coeffs[(i + 1) * coeffs - 1] += 1.0F;
    }
    reactivate(cloud, indices, activated);
    const ActivatedCloud all = activate(cloud);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const Gaussian<float>&a = activated.gaussians[i], &b = all.gaussians[i];
      CHECK((a.mean == b.mean && a.scale == b.scale && a.quat == b.quat && a.opacity == b.opacity));
    }
    CHECK(activated.sh_coeffs == all.sh_coeffs);
  }
}

TEST_CASE("deactivate: activation gives the values back, to the last bits") {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> exponent(-20, 16), component(-1, 1), opacity(0, 1);
  ActivatedCloud cloud;
  for (int i = 0; i < 20000; ++i) {
    Gaussian<float> g{};
    g.mean = {component(random), component(random), component(random)};
    for (int axis = 0; axis < 3; ++axis) g.scale[axis] = std::exp(exponent(random));
    float squared = 0;
    for (float& q : g.quat) {
      q = component(random);
      squared += q * q;
    }
    for (float& q : g.quat) q /= std::sqrt(squared);
    g.opacity = i % 3 == 0 ? static_cast<float>(random() % 256) / 255 : opacity(random);
    cloud.gaussians.push_back(g);
    cloud.sh_coeffs.emplace_back(component(random));
  }
  cloud.gaussians[0].scale = {0, 1, 1e7F};
  const ActivatedCloud back = activate(deactivate(cloud));
  CHECK(back.sh_coeffs == cloud.sh_coeffs);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Gaussian<float>&a = cloud.gaussians[i], &b = back.gaussians[i];
    CAPTURE(i, a.opacity, b.opacity);
    REQUIRE(b.mean == a.mean);
    // Half a step of a logarithm of up to 20, 10^-6, is the relative error of what it is of.
    for (int k = 0; k < 3; ++k) REQUIRE(std::abs(b.scale[k] - a.scale[k]) <= 1.1e-6F * a.scale[k]);
    for (std::size_t k = 0; k < 4; ++k) REQUIRE(std::abs(b.quat[k] - a.quat[k]) <= 2e-7F);
    REQUIRE(std::abs(b.opacity - a.opacity) <= 5e-7F * a.opacity);
    if (a.opacity == 0 || a.opacity == 1) REQUIRE(b.opacity == a.opacity);
  }
}
