// Merging of equal points, drawing by weight.
#include <catch2/catch.hpp>
#include <cstring>
#include <limits>
#include <numeric>
#include <random>

#include "algorithm/vq/kmeans.h"

namespace sgs {
namespace {

TEST_CASE("point set: equal points become one, weights added, by first occurrence") {
  const PointSet points{2, {1, 2, 3, 4, 1, 2, -0.0F, 0, 0, 0, 3, 4}, {1, 2, 4, 8, 16, 32}};
  const DistinctPoints distinct = merge_equal(points);
  // -0 and 0 are equal numbers of different bits: apart.
  CHECK(distinct.points.values == std::vector<float>{1, 2, 3, 4, -0.0F, 0, 0, 0});
  CHECK(distinct.points.weights == std::vector<float>{5, 34, 8, 16});
  CHECK(distinct.original == std::vector<std::uint32_t>{0, 1, 0, 2, 3, 1});
}

TEST_CASE("point set: 20,000 points of 3,000 values keep value and weight") {
  std::mt19937_64 random(1);
  PointSet points{3, {}, {}};
  for (int i = 0; i < 20000; ++i) {
    const auto value = static_cast<float>(random() % 3000);
    points.values.insert(points.values.end(), {value, value * 0.1F, -value});
    points.weights.push_back(static_cast<float>(random() % 16));
  }
  const DistinctPoints distinct = merge_equal(points);
  CHECK(distinct.points.size() <= 3000);
  CHECK(distinct.points.size() > 2900);
  std::vector<double> sums(distinct.points.size(), 0.0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint32_t at = distinct.original[i];
    sums[at] += points.weights[i];
    REQUIRE(std::memcmp(points[i], distinct.points[at], 3 * sizeof(float)) == 0);
  }
  for (std::size_t m = 0; m < sums.size(); ++m) {
    REQUIRE(sums[m] == distinct.points.weights[m]);
  }
}

TEST_CASE("point set: weights that add up beyond float stay finite") {
  constexpr float kMost = std::numeric_limits<float>::max();
  const DistinctPoints distinct = merge_equal({1, {2, 2, 2}, {kMost, kMost, kMost}});
  CHECK(distinct.points.weights == std::vector<float>{kMost});
}

TEST_CASE("point set: nothing") {
  CHECK(merge_equal({4, {}, {}}).points.size() == 0);
  CHECK(draw({4, {}, {}}, 10, 1).size() == 0);
}

TEST_CASE("draw: no more points than asked for come as they are") {
  const PointSet points{1, {1, 2, 3}, {0, 5, 7}};
  const PointSet drawn = draw(points, 3, 1);
  CHECK(drawn.values == points.values);
  CHECK(drawn.weights == points.weights);
}

TEST_CASE("draw: each point as often as its weight says, one more or less") {
  constexpr std::size_t kPoints = 500, kDrawn = 200;
  std::mt19937_64 random(3);
  PointSet points{1, {}, {}};
  for (std::size_t i = 0; i < kPoints; ++i) {
    points.values.push_back(static_cast<float>(i));
    points.weights.push_back(i % 7 == 0 ? 0 : static_cast<float>(random() % 1000) * 0.01F);
  }
  const double total = std::accumulate(points.weights.begin(), points.weights.end(), 0.0);
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const PointSet drawn = draw(points, kDrawn, seed);
    REQUIRE(drawn.size() == kDrawn);
    std::vector<int> times(kPoints, 0);
    for (std::size_t i = 0; i < drawn.size(); ++i) {
      CHECK(drawn.weights[i] == 1);
      ++times[static_cast<std::size_t>(drawn[i][0])];
    }
    for (std::size_t i = 0; i < kPoints; ++i) {
      const double expected = points.weights[i] / total * kDrawn;
      REQUIRE(times[i] > expected - 1);
      REQUIRE(times[i] < expected + 1);
    }
    CHECK(draw(points, kDrawn, seed).values == drawn.values);
  }
  CHECK(draw(points, kDrawn, 1).values != draw(points, kDrawn, 2).values);
}

}  // namespace
}  // namespace sgs
