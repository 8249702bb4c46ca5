// Tests of algorithm/splat/footprint.h: values by hand.
#include "algorithm/splat/footprint.h"

#include <catch2/catch.hpp>
#include <limits>

using namespace sgs;

namespace {

// A round splat of variance `variance` px^2, low-pass included, with its radius.
Projected<float> round_splat(float x, float y, float variance) {
  Projected<float> p{};
  p.x = x;
  p.y = y;
  p.depth = 1;
  p.cov_a = p.cov_c = variance;
  p.determinant = variance * variance;
  p.conic_a = p.conic_c = 1 / variance;
  p.radius = std::ceil(3 * std::sqrt(variance + std::sqrt(0.1F)));
  return p;
}

bool same(const PixelRect& a, const PixelRect& b) {
  return a.x0 == b.x0 && a.y0 == b.y0 && a.x1 == b.x1 && a.y1 == b.y1;
}

}  // namespace

TEST_CASE("tile rectangle by hand") {
  // 100x50 px: 7x4 tiles. x: int(34/16) = 2 to int(81/16) = 5; y: int(4/16) = 0 to int(51/16) = 3.
  CHECK(same(tile_rect(50.0F, 20.0F, 16.0F, 100, 50), {2, 0, 5, 3}));
  CHECK(same(tile_rect(50.0, 20.0, 16.0, 100, 50), {2, 0, 5, 3}));
}

TEST_CASE("tile rectangle: integers are cut toward zero, so a splat left of the frame is dropped") {
  CHECK(tile_rect(-5.0F, 20.0F, 5.0F, 100, 50).empty());   // (-5 + 5 + 15)/16 < 1
  CHECK(!tile_rect(-4.0F, 20.0F, 5.0F, 100, 50).empty());  // (-4 + 5 + 15)/16 = 1
  CHECK(same(tile_rect(-4.0F, 20.0F, 5.0F, 100, 50), {0, 0, 1, 2}));
  // Right of the last tile, which ends at 112: int((120 - 7)/16) = 7.
  CHECK(tile_rect(120.0F, 20.0F, 7.0F, 100, 50).empty());
  CHECK(!tile_rect(120.0F, 20.0F, 9.0F, 100, 50).empty());
}

TEST_CASE("tile rectangle: values outside the range of int cover all or nothing") {
  const float huge = 1e30F, infinite = std::numeric_limits<float>::infinity();
  CHECK(same(tile_rect(0.0F, 0.0F, huge, 100, 50), {0, 0, 7, 4}));
  CHECK(same(tile_rect(0.0F, 0.0F, infinite, 100, 50), {0, 0, 7, 4}));
  CHECK(tile_rect(huge, 0.0F, 5.0F, 100, 50).empty());
  CHECK(tile_rect(-huge, 0.0F, 5.0F, 100, 50).empty());
}

TEST_CASE("footprint by hand: the box around the visible ellipse") {
  // Half-extent 2 sqrt(2 ln 255) = 6.658: x in [43.642, 56.958], y in [13.942, 27.258];
  // pixels 44..56 and 14..27; sub-tiles 11..14 and 3..6.
  CHECK(footprint(round_splat(50.3F, 20.6F, 4), 1.0F, 100, 50) == SubtileRect{11, 3, 15, 7});
  // Opacity 0.02: 2 sqrt(2 ln 5.1) = 3.610: pixels 47..53 and 17..24.
  CHECK(footprint(round_splat(50.3F, 20.6F, 4), 0.02F, 100, 50) == SubtileRect{11, 4, 14, 7});
}

TEST_CASE("footprint by hand: tiles cut a wide opaque splat before its ellipse does") {
  // sigma 100: the ellipse reaches 10 + 332.9, the radius 301 gives int((10 + 301 + 15)/16) = 20
  // tiles.
  CHECK(footprint(round_splat(10, 10, 10000), 1.0F, 1000, 1000) == SubtileRect{0, 0, 80, 80});
}

TEST_CASE("footprint: cut to the frame, its last sub-tile may be partly outside") {
  CHECK(footprint(round_splat(50, 25, 10000), 1.0F, 101, 50) == SubtileRect{0, 0, 26, 13});
}

TEST_CASE("footprint: nothing below opacity 1/255, off the frame, or in no tile") {
  CHECK(!footprint(round_splat(50, 20, 4), 1.0F / 255, 100, 50).empty());  // visible at its centre
  CHECK(footprint(round_splat(50, 20, 4), 0.99F / 255, 100, 50).empty());
  CHECK(footprint(round_splat(50, 20, 4), 0.0F, 100, 50).empty());
  CHECK(footprint(round_splat(50, 90, 4), 1.0F, 100, 50).empty());
  // Tiles reach to 112 px and the radius to the last of them, but no pixel of the frame is visible.
  CHECK(footprint(round_splat(108, 20, 4), 1.0F, 100, 50).empty());
}

TEST_CASE("footprint: beyond the condition that the bound covers, only the tiles cut") {
  auto p = round_splat(50, 20, 100);
  p.determinant = 0.09F;  // tr^2/det = 444,444: a needle across the frame
  CHECK(footprint(p, 0.02F, 1000, 1000) == SubtileRect{4, 0, 24, 16});  // radius 31
}

TEST_CASE("least_q by hand") {
  // Unit circle: the corner (3, 4) of the rectangle is nearest.
  CHECK(least_q<float>(0, 0, 1, 0, 1, {3, 4, 5, 6}) == 25);
  CHECK(least_q<float>(0, 0, 1, 0, 1, {-6, -5, -2, -3}) == 25);  // corner (-3, -4)
  CHECK(least_q<float>(0, 0, 1, 0, 1, {-1, -1, 2, 2}) == 0);
  // 2 + 2 dy + 2 dy^2 along dx = 1: least at dy = -1/2.
  CHECK(least_q<float>(0, 0, 2, 1, 2, {1, -5, 3, 6}) == 1.5F);
  // The minimum of that edge lies outside it: at dy = 1, 2 + 2 + 2.
  CHECK(least_q<float>(0, 0, 2, 1, 2, {1, 1, 3, 6}) == 6);
}

TEST_CASE("reaches: touching, just missing, and a conic that is flat") {
  const float cutoff = 25;
  CHECK(reaches<float>(0, 0, 1, 0, 1, cutoff, {3, 4, 5, 6}));
  CHECK_FALSE(reaches<float>(0, 0, 1, 0, 1, 24.9F, {3, 4, 5, 6}));
  CHECK(reaches<float>(0, 0, 0, 0, 0, cutoff, {3, 4, 5, 6}));
  CHECK(reaches<float>(0, 0, std::numeric_limits<float>::quiet_NaN(), 0, 1, cutoff, {3, 4, 5, 6}));
}
