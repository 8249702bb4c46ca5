// Back to a file's parameters, and forward again.
#include "algorithm/splat/deactivate.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "algorithm/splat/activate.h"

using namespace sgs;

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
