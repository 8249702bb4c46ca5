// Tests of algorithm/splat/extent_bound.h: values by hand, the two ways to cut, and what the root
// of the reach gives away. (That nothing is lost: bounds_test.cpp,
// ../voxel/chunk_bound_checks.cpp.)
#include "algorithm/splat/extent_bound.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "tests/algorithm/splat/camera_at_origin.h"

namespace sgs {
namespace {

using test::camera_at_origin;

constexpr double kLowPassReach = 0.3 * (2 * 5.541263545158426 + 1e-4);  // px^2, 2 ln 255

TEST_CASE("extent bound by hand") {
  // v = (1, 0.5, 4): u = 0.25, w = 0.125, n_x = (1, 0, -0.25), n_y = (0, 1, -0.125).
  const auto bound =
      extent_bound(make_view<float>(camera_at_origin()), {1, 0.5F, 4}, {0.4F, 0.8F, 1.6F}, 0.6F);
  const double reach_x = 25 * (0.4 + 0.25 * 1.6), reach_y = 20 * (0.8 + 0.125 * 1.6);
  // lambda = (100 * 0.6 / 4)^2 (1 + 0.0625 + 0.015625) + 0.3
  const double widened = 1 + 64 * 0x1p-24 * 4 / 0.3 * (225 * 1.078125 + 0.3);
  CHECK(bound.in_front);
  CHECK(bound.depth == 4);
  CHECK(bound.x == 74.5F);
  CHECK(bound.y == 34.5F);
  CHECK(bound.slack_px == 0.05F);
  for (const auto& [found, reach] :
       {std::pair(bound.reach_squared_x, reach_x), std::pair(bound.reach_squared_y, reach_y)}) {
    const double least = (reach * reach + kLowPassReach) * widened;
    CHECK(found >= least);
    CHECK(found < least * 1.0006);
  }
}

TEST_CASE("extent bound: on and behind the near plane nothing is in front") {
  const auto view = make_view<float>(camera_at_origin());
  const glm::vec3 extent(1);
  CHECK_FALSE(extent_bound(view, {0, 0, 0.2F}, extent, 1.0F).in_front);
  CHECK_FALSE(extent_bound(view, {0, 0, -4}, extent, 1.0F).in_front);
  CHECK(extent_bound(view, {0, 0, std::nextafter(0.2F, 1.0F)}, extent, 1.0F).in_front);
}

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

TEST_CASE("extent bound: a rectangle of pixels is touched along both axes or not at all") {
  // 2 px beside the slack along x, 3 along y.
  const ExtentBound bound{true, 1, 10, 20, 0.5F, 4, 9};
  CHECK(touches(bound, {0, 0, 30, 30}));
  CHECK(touches(bound, {12, 0, 30, 30}));
  CHECK_FALSE(touches(bound, {13, 0, 30, 30}));
  CHECK(touches(bound, {0, 0, 9, 30}));  // the last pixel is 8
  CHECK_FALSE(touches(bound, {0, 0, 8, 30}));
  CHECK(touches(bound, {0, 23, 30, 30}));
  CHECK_FALSE(touches(bound, {0, 24, 30, 30}));
  CHECK(touches(bound, {0, 0, 30, 18}));
  CHECK_FALSE(touches(bound, {0, 0, 30, 17}));
  CHECK(touches(bound, {12, 23, 30, 30}));  // off a corner
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

TEST_CASE("group reach by hand") {
  struct Row {
    float x, y, slack_px, squared_x, squared_y;
    PixelRect group;
    int x0, y0, x1, y1;
  };
  const float infinite = std::numeric_limits<float>::infinity();
  const float none = std::numeric_limits<float>::quiet_NaN();
  const Row rows[] = {
      // 2.05 px along x, 3.05 along y, each 1 % more: 8 to 12 and 17 to 23 of 64 px.
      {10, 20, 0.05F, 4, 9, {0, 0, 64, 64}, 2, 4, 3, 5},
      // The same relative to a corner.
      {138, 84, 0.05F, 4, 9, {128, 64, 192, 128}, 2, 4, 3, 5},
      // The first pixel is 12, the last one 15: one column.
      {13.5F, 2, 0.05F, 2.25F, 1, {0, 0, 64, 64}, 3, 0, 3, 0},
      // Over all edges, and from without over one.
      {30, 30, 0, 1e6F, 1e6F, {0, 0, 64, 60}, 0, 0, 15, 14},
      {-5, 70, 0, 49, 100, {0, 0, 64, 64}, 0, 15, 0, 15},
      // Nothing is known.
      {30, 30, 0, infinite, infinite, {0, 0, 64, 64}, 0, 0, 15, 15},
      {none, none, 0, 4, 4, {0, 0, 64, 64}, 0, 0, 15, 15},
  };
  for (const Row& row : rows) {
    const ExtentBound bound{true, 1, row.x, row.y, row.slack_px, row.squared_x, row.squared_y};
    const GroupReach found = group_reach(bound, row.group);
    CAPTURE(row.x, row.y);
    CHECK(int{found.x0} == row.x0);
    CHECK(int{found.y0} == row.y0);
    CHECK(int{found.x1} == row.x1);
    CHECK(int{found.y1} == row.y1);
  }
}

}  // namespace
}  // namespace sgs
