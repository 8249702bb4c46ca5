// Shares of Gaussians look like what they were shares of.
#include "algorithm/train/relocation.h"

#include <catch2/catch.hpp>
#include <cmath>

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
