// Quantised nodes of the chunk tree: what comes back is never smaller than what went in.
#include <catch2/catch.hpp>
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

TEST_CASE("an infinite extent comes back infinite, and so do its neighbours") {
  ChunkBound wide, other;
  wide.extent = {kInfinity, 1, 1};
  other.extent = {1, 1, 1};
  const ChunkNode node = quantised({wide, other});
  check_never_inward({wide, other});
  CHECK(child_bound(node, 0).extent.x == kInfinity);
  CHECK(child_bound(node, 1).extent.y == kInfinity);
}
