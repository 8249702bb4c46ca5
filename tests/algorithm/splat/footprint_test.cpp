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

TEST_CASE("footprint: beyond the condition that the bound covers, only the tiles cut") {
  auto p = round_splat(50, 20, 100);
  p.determinant = 0.09F;  // tr^2/det = 444,444: a needle across the frame
  CHECK(footprint(p, 0.02F, 1000, 1000) == SubtileRect{4, 0, 24, 16});  // radius 31
}
