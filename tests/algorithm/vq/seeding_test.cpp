// Seeding against a plain loop: the same points, whatever their number and weights.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "algorithm/vq/kmeans.h"

namespace sgs {
namespace {

using Random = std::mt19937_64;

float bounded_squared_distance(const float* a, const float* b, int dims) {
  float sum = 0;
  for (int d = 0; d < dims; ++d) sum += (a[d] - b[d]) * (a[d] - b[d]);
  return std::min(sum, std::numeric_limits<float>::max());
}

std::size_t point_at(const std::vector<double>& mass, double target) {
  std::size_t last = 0;
  for (std::size_t i = 0; i < mass.size(); ++i) {
    if (mass[i] <= 0) continue;
    last = i;
    target -= mass[i];
    if (target < 0) break;
  }
  return last;
}

std::vector<float> plain_seeds(const PointSet& points, std::uint32_t entries, std::uint64_t seed) {
  constexpr std::size_t kBlock = 2048;  // of a sum
  Random random(seed);
  std::vector<float> centroids, nearest(points.size(), std::numeric_limits<float>::infinity());
  std::vector<double> mass(points.weights.begin(), points.weights.end());
  double total = std::accumulate(mass.begin(), mass.end(), 0.0);
  for (std::uint32_t entry = 0; entry < entries && total > 0; ++entry) {
    const double share = static_cast<double>(random() >> 11) * 0x1p-53;
    const float* chosen = points[point_at(mass, share * total)];
    centroids.insert(centroids.end(), chosen, chosen + points.dims);
    total = 0;
    for (std::size_t begin = 0; begin < points.size(); begin += kBlock) {
      double of_block = 0;
      for (std::size_t i = begin; i < std::min(points.size(), begin + kBlock); ++i) {
        nearest[i] = std::min(nearest[i], bounded_squared_distance(points[i], chosen, points.dims));
        mass[i] = static_cast<double>(points.weights[i]) * nearest[i];
        of_block += mass[i];
      }
      total += of_block;
    }
  }
  return centroids;
}

float uniform(Random& random, float low, float high) {
  return std::uniform_real_distribution<float>(low, high)(random);
}

PointSet random_points(Random& random, std::size_t count, int dims) {
  PointSet points{dims, {}, {}};
  for (std::size_t i = 0; i < count; ++i) {
    for (int d = 0; d < dims; ++d) points.values.push_back(uniform(random, -1, 1));
    points.weights.push_back(uniform(random, 0, 1));
  }
  return points;
}

TEST_CASE("seeding: of few and many points, in all dimensions") {
  Random random(1);
  for (const int dims : {1, 2, 3, 4, 5, 24}) {
    for (const std::size_t count : {1U, 7U, 2047U, 2048U, 2049U, 20000U}) {
      INFO(count << " points of " << dims << " dimensions");
      const PointSet points = random_points(random, count, dims);
      CHECK(seed_centroids(points, 200, count) == plain_seeds(points, 200, count));
    }
  }
}

TEST_CASE("seeding: no more entries than distinct points of any weight") {
  Random random(2);
  PointSet points = random_points(random, 5000, 3);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i % 100 != 0) points.weights[i] = 0;
  }
  const std::vector<float> seeds = seed_centroids(points, 200, 3);
  CHECK(seeds.size() == 50 * 3);
  CHECK(seeds == plain_seeds(points, 200, 3));
}

TEST_CASE("seeding: weights and distances of any size") {
  Random random(3);
  PointSet points = random_points(random, 5000, 2);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points.weights[i] = std::pow(10.0F, uniform(random, -38, 38));
    if (i % 7 == 0) points.values[2 * i] = 3e38F * uniform(random, -1, 1);
  }
  CHECK(seed_centroids(points, 300, 4) == plain_seeds(points, 300, 4));
}

}  // namespace
}  // namespace sgs
