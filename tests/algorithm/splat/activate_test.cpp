// Tests of algorithm/splat/activate.h.
#include "algorithm/splat/activate.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace sgs;

TEST_CASE("activation by hand: exp, sigmoid, unit quaternion, coefficients as they are") {
  GaussianCloud cloud;
  cloud.resize(2, 1);
  cloud.means[0] = {1, 2, 3};
  cloud.log_scales[0] = {0, std::log(2.0F), -23};
  cloud.quats[0] = {3, 0, -4, 0};
  cloud.opacity_logits[0] = std::log(3.0F);
  for (std::size_t k = 0; k < 8; ++k) cloud.sh_coeffs[k] = glm::vec3(static_cast<float>(k));
  cloud.quats[1] = {1e-20F, 1e-20F, 1e-20F, 1e-20F};  // squares underflow in float
  cloud.opacity_logits[1] = 200;

  const ActivatedCloud out = activate(cloud);
  REQUIRE(out.size() == 2);
  CHECK(out.sh_degree == 1);
  const auto& g = out.gaussians[0];
  CHECK(g.mean == glm::vec3(1, 2, 3));
  CHECK(g.scale.x == 1);
  CHECK(g.scale.y == Approx(2).epsilon(1e-6));
  CHECK(g.scale.z == static_cast<float>(std::exp(-23.0)));
  CHECK(g.quat == std::array<float, 4>{0.6F, 0, -0.8F, 0});
  CHECK(g.opacity == Approx(0.75).epsilon(1e-6));
  CHECK(out.gaussians[1].quat == std::array<float, 4>{0.5F, 0.5F, 0.5F, 0.5F});
  CHECK(out.gaussians[1].opacity == 1);
  CHECK(out.sh(1)[2] == glm::vec3(6));  // entry 4 + 2
}

TEST_CASE("activation of an empty cloud is empty") { CHECK(activate(GaussianCloud{}).size() == 0); }
