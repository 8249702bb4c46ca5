// Visible extents against formulas in double, and their code: never down, seldom far up.
#include "algorithm/splat/visible_extents.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "algorithm/scene/gaussian_cloud.h"
#include "tests/algorithm/splat/random_gaussian.h"

namespace sgs {
namespace {

const double kStep = std::exp2(1 / 16.0);

double largest(const Gaussian<float>& g) { return std::max({g.scale.x, g.scale.y, g.scale.z}); }

// sqrt(Sigma_aa), Sigma = sum over the axes of the ellipsoid of scale^2 r r^T, with r the axis that
// the quaternion turns e_axis to.
double sigma_along(const Gaussian<float>& g, int a) {
  const double w = g.quat[0];
  const glm::dvec3 v{g.quat[1], g.quat[2], g.quat[3]};
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 e(0);
    e[axis] = 1;
    const glm::dvec3 turned = e + 2.0 * glm::cross(v, glm::cross(v, e) + w * e);
    sum += std::pow(turned[a] * g.scale[axis], 2);
  }
  return std::sqrt(sum);
}

TEST_CASE("visible extents: no less than in double, no more than rounding") {
  test::RandomGaussians random(31, 200, 100);
  for (int i = 0; i < 20000; ++i) {
    const Gaussian<float> g = random.gaussian(random.camera());
    const double k = std::sqrt(std::max(0.0, 2 * std::log(255.0 * g.opacity)));
    const VisibleExtents found = visible_extents(g);
    for (int a = 0; a < 3; ++a) {
      // A needle's thin axes cancel in float: to 1e-6 of the largest scale.
      const double expected = k * sigma_along(g, a), rounding = 4e-6 * largest(g);
      REQUIRE(found.extent[a] >= expected - rounding);
      REQUIRE(found.extent[a] <= (k + 0.011) * sigma_along(g, a) * 1.0001 + rounding);
    }
  }
}

TEST_CASE("extent code: decodes to no less, and to the next level at most") {
  test::RandomGaussians random(32, 200, 100);
  for (int i = 0; i < 50000; ++i) {
    VisibleExtents extents;
    extents.scale_max = static_cast<float>(random.log_uniform(1e-9, kMaxScale));
    for (int a = 0; a < 3; ++a) {
      const double part = random.pick(9) == 0 ? 1 : random.log_uniform(1e-8, 1);
      extents.extent[a] = static_cast<float>(3.3291 * extents.scale_max * part);
    }
    const VisibleExtents back = decode_extents(encode_extents(extents));
    REQUIRE(back.scale_max >= extents.scale_max);
    const double least = std::exp2(-8);
    REQUIRE(back.scale_max <= std::max(least, extents.scale_max * kStep * kStep) * 1.000001);
    // The lowest level lies 255 steps below the highest.
    const double floor = back.scale_max * std::exp2((28 - 255) / 16.0);
    for (int a = 0; a < 3; ++a) {
      REQUIRE(back.extent[a] >= extents.extent[a]);
      REQUIRE(back.extent[a] <= std::max(floor, extents.extent[a] * kStep) * 1.000001);
    }
  }
}

TEST_CASE("extent code: the ends") {
  const VisibleExtents nothing = decode_extents(encode_extents({{0, 0, 0}, 0}));
  CHECK(nothing.scale_max == Approx(std::exp2(-8)));
  CHECK(nothing.extent.x < 3e-7);
  const float most = static_cast<float>(kMaxScale * (1 + 1e-5));
  const float reach = most * 3.3291F;
  const VisibleExtents all = decode_extents(encode_extents({{reach, reach, reach}, most}));
  CHECK(all.scale_max >= most);
  CHECK(all.extent.x >= reach);
  CHECK(all.scale_max <= most * kStep * kStep * 1.000001);
  const VisibleExtents beyond = decode_extents(encode_extents({{1, 1, 1}, 1.5e7F}));
  CHECK(std::isinf(beyond.scale_max));
  CHECK(std::isinf(beyond.extent.y));
  // Exactly on a level: it stays there but for the rounding up.
  const ExtentCode one = encode_extents({{1, 1, 1}, 1});
  CHECK(decode_extents(one).scale_max == std::nextafter(1.0F, 2.0F));
  CHECK(one.below[0] == 28);
}

}  // namespace
}  // namespace sgs
