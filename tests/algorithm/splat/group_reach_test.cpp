// Tests of algorithm/splat/group_reach.h: values by hand, and what its root gives away. (That no
// visible pixel is lost: bounds_test.cpp.)
#include "algorithm/splat/group_reach.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

namespace sgs {
namespace {

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
