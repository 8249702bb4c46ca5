// Both searches against a plain loop: the same index and the same bits of the distance.
#include "algorithm/vq/nearest.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <random>

#include "tests/support/uniform.h"

namespace sgs {
namespace {

using test::uniform;
using Random = std::mt19937_64;
using Coordinate = std::function<float(Random&)>;

Nearest plain_loop(const std::vector<float>& centroids, std::size_t dims, const float* point) {
  Nearest best{0, std::numeric_limits<float>::infinity()};
  for (std::size_t c = 0; c < centroids.size() / dims; ++c) {
    float sum = 0;
    for (std::size_t d = 0; d < dims; ++d) {
      const float difference = point[d] - centroids[c * dims + d];
      sum += difference * difference;
    }
    if (sum < best.squared_distance) best = {static_cast<std::uint32_t>(c), sum};
  }
  return best;
}

std::vector<float> draw_points(Random& random, std::size_t count, std::size_t dims,
                               const Coordinate& coordinate) {
  std::vector<float> points(count * dims);
  for (float& value : points) value = coordinate(random);
  return points;
}

// Asks for every centroid itself and for points of the same kind, with hints near and far.
void check_searches(Random& random, std::size_t entries, std::size_t dims,
                    const Coordinate& coordinate) {
  INFO(entries << " entries of " << dims << " dimensions");
  const std::vector<float> centroids = draw_points(random, entries, dims, coordinate);
  std::vector<float> points = draw_points(random, 200, dims, coordinate);
  points.insert(points.end(), centroids.begin(), centroids.end());
  const int d = static_cast<int>(dims);
  const auto tree = make_kd_tree(centroids, d), all = make_exhaustive_search(centroids, d),
             chosen = make_search(centroids, d);
  for (std::size_t p = 0; p < points.size() / dims; ++p) {
    const float* point = points.data() + p * dims;
    const Nearest expected = plain_loop(centroids, dims, point);
    const auto anywhere = static_cast<std::uint32_t>(random() % entries);
    for (const std::uint32_t hint :
         {0U, expected.index, anywhere, static_cast<std::uint32_t>(entries - 1), ~0U}) {
      for (const NearestSearch* search : {tree.get(), all.get(), chosen.get()}) {
        const Nearest got = search->find(point, hint);
        REQUIRE(got.index == expected.index);
        REQUIRE(got.squared_distance == expected.squared_distance);
      }
    }
  }
}

void check_sizes(const Coordinate& coordinate) {
  Random random(1);
  for (const std::size_t dims : {1U, 2U, 3U, 4U, 5U, 45U}) {
    for (const std::size_t entries : {1U, 2U, 7U, 8U, 9U, 16U, 17U, 300U}) {
      check_searches(random, entries, dims, coordinate);
    }
  }
}

TEST_CASE("nearest: random points") {
  check_sizes([](Random& random) { return uniform(random, -1, 1); });
}

TEST_CASE("nearest: clusters far apart") {
  check_sizes([](Random& random) {
    return 100.0F * static_cast<float>(random() % 3) + 1e-3F * uniform(random, -1, 1);
  });
}

TEST_CASE("nearest: a lattice, so that most points are as near to many centroids") {
  check_sizes([](Random& random) { return 0.5F * static_cast<float>(random() % 5); });
}

TEST_CASE("nearest: few distinct values, so that centroids are duplicates of each other") {
  check_sizes([](Random& random) { return static_cast<float>(random() % 2); });
  check_sizes([](Random&) { return 7.25F; });
}

TEST_CASE("nearest: values from 1e-30 to 1e30, whose squares leave the range of float") {
  check_sizes([](Random& random) {
    return std::pow(10.0F, uniform(random, -30, 30)) * (random() % 2 == 0 ? 1.0F : -1.0F);
  });
  check_sizes([](Random& random) { return random() % 2 == 0 ? 1e30F : uniform(random, -1, 1); });
  check_sizes([](Random& random) { return random() % 2 == 0 ? 3.4e38F : -3.4e38F; });
}

TEST_CASE("nearest: a thousand entries of each codebook's dimensions") {
  Random random(2);
  for (const std::size_t dims : {2U, 3U, 4U, 24U, 45U}) {
    check_searches(random, 1000, dims, [](Random& r) { return uniform(r, -1, 1); });
  }
}

}  // namespace
}  // namespace sgs
