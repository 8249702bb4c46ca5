// Tests of algorithm/splat/extent_bound.h: where it stops bounding, and what the root of the reach
// gives away. (That nothing is lost: bounds_test.cpp, ../voxel/chunk_bound_checks.cpp.)
#include "algorithm/splat/extent_bound.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "tests/algorithm/splat/camera_at_origin.h"

namespace sgs {
namespace {

using test::camera_at_origin;

TEST_CASE("extent bound: wider than the bound on rounding, only tiles cut") {
  const auto view = make_view<float>(camera_at_origin());
  // lambda = (25 S)^2 + 0.3; its widening reaches 1/2 at 9830 px^2: S = 3.9658.
  const auto below = extent_bound(view, {0, 0, 4}, {0.1F, 0.1F, 0.1F}, 3.96F);
  CHECK(below.slack_px == 0.05F);
  CHECK(below.reach_squared_x < 20);
  const auto beyond = extent_bound(view, {0, 0, 4}, {0.1F, 0.1F, 0.1F}, 3.97F);
  CHECK(beyond.slack_px >= 17);
  CHECK(beyond.reach_squared_x >= 9 * (99.25 * 99.25 + 0.3 + 0.3162));
  CHECK(beyond.reach_squared_x == beyond.reach_squared_y);
  CHECK(touches(extent_bound(view, {0, 0, 0.3F}, glm::vec3(3e7F), 1e7F), {0, 0, 4, 4}));
}

TEST_CASE("root above: no less than the root and 2^-9 of it, no more than 2^-6.5") {
  for (float x = 1; x < 1e30F; x *= 1.00037F) {
    const double root = std::sqrt(static_cast<double>(x));
    const double found = static_cast<double>(root_above(x));
    if (!(found >= root * (1 + 0x1p-9 - 0x1p-22))) FAIL("too small at " << x);
    if (!(found <= root * 1.0111)) FAIL("too large at " << x);
  }
  CHECK(root_above(std::numeric_limits<float>::infinity()) ==
        std::numeric_limits<float>::infinity());
  CHECK(root_above(1.0F) == 1.0F + 0x1p-9F);
}

}  // namespace
}  // namespace sgs
