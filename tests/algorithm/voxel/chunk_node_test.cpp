// Quantised nodes of the chunk tree: what comes back is never smaller than what went in.
#include <catch2/catch.hpp>
#include <cfenv>
#include <cmath>
#include <random>
#include <vector>

#include "algorithm/voxel/chunk_tree.h"
#include "tests/algorithm/voxel/chunk_bound_checks.h"

using namespace sgs;
using sgs::test::holds;

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

ChunkNode quantised(const std::vector<ChunkBound>& bounds) {
  ChunkNode node;
  node.children = static_cast<std::uint8_t>(bounds.size());
  quantise(bounds.data(), node);
  return node;
}

void check_never_inward(const std::vector<ChunkBound>& bounds) {
  const ChunkNode node = quantised(bounds);
  for (int c = 0; c < node.children; ++c) {
    if (!holds(child_bound(node, c), bounds[static_cast<std::size_t>(c)])) FAIL("child " << c);
  }
}

// Bounds whose coordinates are `offset` + up to `size`, extents up to `extent`.
std::vector<ChunkBound> random_bounds(std::mt19937& random, double offset, double size,
                                      double extent) {
  std::uniform_real_distribution<double> uniform;
  std::vector<ChunkBound> bounds(1 + random() % kChunkNodeWidth);
  for (ChunkBound& b : bounds) {
    for (int k = 0; k < 3; ++k) {
      const auto a = static_cast<float>(offset + size * (uniform(random) - 0.5));
      const auto z = static_cast<float>(offset + size * (uniform(random) - 0.5));
      b.low[k] = std::min(a, z);
      b.high[k] = random() % 5 == 0 ? b.low[k] : std::max(a, z);
      b.extent[k] = static_cast<float>(extent * std::exp2(-40 * uniform(random)));
    }
    b.scale_max = static_cast<float>(extent * uniform(random));
  }
  return bounds;
}

}  // namespace

TEST_CASE("a node quantised by hand") {
  // Width 255 along x: steps of 1. Largest extent 3: exponent 2, q = 255 - ceil(16 log2(4 / 3)).
  ChunkBound a, b;
  a.low = {0, 0, 0};
  a.high = {10.25F, 0, 0};
  a.extent = {3, 3, 3};
  b.low = {99.75F, 0, 0};
  b.high = {255, 0, 0};
  b.extent = {3, 0, 3};
  const ChunkNode node = quantised({a, b});
  CHECK(node.step_exponent[0] == 0);
  CHECK(node.low[0][0] == 0);
  CHECK(node.high[0][0] == 11);
  CHECK(node.low[1][0] == 99);
  CHECK(node.high[1][0] == 255);
  CHECK(node.extent_exponent == 2);
  CHECK(node.extent[0][0] == 249);
  CHECK(node.extent[1][1] == 0);
  // 4 x 2^(-6/16), a sixteenth of an octave above 3 at most.
  CHECK(child_bound(node, 0).extent.x == Approx(3.0844).epsilon(1e-4));
}

TEST_CASE("quantisation is never inward, whatever the magnitudes") {
  std::mt19937 random(1);
  for (int round = 0; round < 400; ++round) {
    for (const double offset : {0.0, 1.0, -1.0, 1e6, -1e6, 1e-30, 3e37, -3e37}) {
      for (const double size : {0.0, 1e-42, 1e-30, 1e-3, 1.0, 1e5, 1e30}) {
        constexpr double kExtents[] = {0, 1e-45, 1e-30, 1e-3, 1, 1e5, 1e30, 3e38};
        check_never_inward(random_bounds(random, offset, size, kExtents[random() % 8]));
      }
    }
  }
}

TEST_CASE(
    "quantisation loses at most two steps of a box and a sixteenth of an octave of an extent") {
  std::mt19937 random(2);
  for (int round = 0; round < 2000; ++round) {
    const std::vector<ChunkBound> bounds = random_bounds(random, 0, 10, 1);
    const ChunkNode node = quantised(bounds);
    ChunkBound all = bounds[0];
    for (const ChunkBound& b : bounds) all = merged(all, b);
    for (int c = 0; c < node.children; ++c) {
      const ChunkBound& in = bounds[static_cast<std::size_t>(c)];
      const ChunkBound out = child_bound(node, c);
      for (int k = 0; k < 3; ++k) {
        // A step is below 2/255 of the width; 2^-16 of the largest is the least extent there is.
        const float step = (all.high[k] - all.low[k]) * 2 / 255 * 1.001F + 1e-30F;
        REQUIRE(in.low[k] - out.low[k] <= step);
        REQUIRE(out.high[k] - in.high[k] <= step);
        REQUIRE(out.extent[k] <= std::max(in.extent[k] * 1.0445F, 4e-5F));
      }
    }
  }
}

TEST_CASE("equal boxes, boxes of floats that are neighbours, the whole range of float") {
  const auto box = [](float low, float high, float extent) {
    ChunkBound b;
    b.low = glm::vec3(low);
    b.high = glm::vec3(high);
    b.extent = glm::vec3(extent);
    b.scale_max = extent;
    return b;
  };
  const float denormal = std::numeric_limits<float>::denorm_min();
  const float most = std::numeric_limits<float>::max();
  check_never_inward(std::vector<ChunkBound>(8, box(3.7F, 3.7F, 0.1F)));
  check_never_inward(std::vector<ChunkBound>(8, box(-1e6F, -1e6F, denormal)));
  check_never_inward({box(1e6F, std::nextafter(1e6F, kInfinity), 1e-3F), box(1e6F, 1e6F, 0)});
  check_never_inward({box(0, denormal, denormal), box(-denormal, 0, 0)});
  check_never_inward({box(-most, most, most), box(0, 1, 1), box(-most, -most, 0)});
  check_never_inward({box(0, most, 0), box(most, most, 1e38F)});
}

TEST_CASE("a node without width is its origin, and nothing undefined is computed") {
  ChunkBound point;
  point.low = point.high = {3.7F, 0, -1e6F};
  std::feclearexcept(FE_ALL_EXCEPT);
  const ChunkNode node = quantised({point, point});
  CHECK(std::fetestexcept(FE_INVALID | FE_DIVBYZERO) == 0);  // as the logarithm of 0 would be
  for (int k = 0; k < 3; ++k) {
    CHECK(node.origin[k] == point.low[k]);
    CHECK(node.step_exponent[k] == -126);
  }
  // No extent either: the least exponent, and the step that stands for none.
  CHECK(node.extent_exponent == -100);
  for (int c = 0; c < 2; ++c) {
    for (int k = 0; k < 3; ++k) {
      CHECK(node.low[c][k] == 0);
      CHECK(node.high[c][k] == 0);
      CHECK(node.extent[c][k] == 0);
    }
    CHECK(child_bound(node, c).low == point.low);
    CHECK(child_bound(node, c).high == point.high);
  }
}

TEST_CASE("an infinite extent comes back infinite, and so do its neighbours") {
  ChunkBound wide, other;
  wide.extent = {kInfinity, 1, 1};
  other.extent = {1, 1, 1};
  const ChunkNode node = quantised({wide, other});
  check_never_inward({wide, other});
  CHECK(child_bound(node, 0).extent.x == kInfinity);
  CHECK(child_bound(node, 1).extent.y == kInfinity);
}
