// k-means: what must hold of every result, and the inputs at its edges.
#include "algorithm/vq/kmeans.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "algorithm/vq/nearest.h"
#include "tests/support/uniform.h"

namespace sgs {
namespace {

using test::uniform;
using Random = std::mt19937_64;

// Points around `clusters` centres, weights over four decades, some 0.
PointSet clustered(std::uint64_t seed, std::size_t count, int dims, std::size_t clusters) {
  Random random(seed);
  std::vector<float> centres(clusters * static_cast<std::size_t>(dims));
  for (float& value : centres) value = uniform(random, -10, 10);
  PointSet points;
  points.dims = dims;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t cluster = random() % clusters;
    for (std::size_t d = 0; d < static_cast<std::size_t>(dims); ++d) {
      points.values.push_back(centres[cluster * static_cast<std::size_t>(dims) + d] +
                              uniform(random, -1, 1));
    }
    points.weights.push_back(random() % 20 == 0 ? 0 : std::pow(10.0F, uniform(random, -2, 2)));
  }
  return points;
}

KMeansConfig config_of(std::uint32_t entries, std::uint32_t iterations, std::uint64_t seed = 1) {
  KMeansConfig config;
  config.entries = entries;
  config.iterations = iterations;
  config.seed = seed;
  return config;
}

double squared_distance(const float* a, const float* b, int dims) {
  double sum = 0;
  for (int d = 0; d < dims; ++d) sum += std::pow(static_cast<double>(a[d]) - b[d], 2);
  return sum;
}

// Labels name the nearest centroid, the error is the weighted mean of their squared distances.
void check_labels(const PointSet& points, const KMeansResult& result) {
  const std::uint32_t entries = result.entries(points.dims);
  const auto dims = static_cast<std::size_t>(points.dims);
  REQUIRE(result.labels.size() == points.size());
  double error = 0, weight = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    REQUIRE(result.labels[i] < entries);
    const double own =
        squared_distance(points[i], &result.centroids[result.labels[i] * dims], points.dims);
    for (std::uint32_t entry = 0; entry < entries; ++entry) {
      REQUIRE(own <= squared_distance(points[i], &result.centroids[entry * dims], points.dims) *
                             (1 + 1e-5) +
                         1e-30);
    }
    error += points.weights[i] * own;
    weight += points.weights[i];
  }
  CHECK(result.mean_squared_error == Approx(error / weight).epsilon(1e-5));
}

TEST_CASE("k-means: labels are nearest, the error is what they leave") {
  for (const int dims : {1, 2, 4, 7}) {
    const PointSet points = clustered(5, 3000, dims, 40);
    for (const std::uint32_t iterations : {0U, 1U, 20U}) {
      INFO(dims << " dimensions, " << iterations << " iterations");
      const KMeansResult result = kmeans(points, config_of(50, iterations));
      CHECK(result.entries(dims) == 50);
      CHECK(result.iterations <= iterations);
      check_labels(points, result);
    }
  }
}

TEST_CASE("k-means: at convergence each centroid is the weighted mean of its points") {
  // Clusters so far apart that Lloyd comes to rest.
  PointSet points = clustered(6, 2000, 3, 8);
  for (float& value : points.values) value = std::round(value * 4);
  const KMeansResult result = kmeans(points, config_of(8, 1000));
  CHECK(result.iterations < 1000);
  std::vector<double> sums(8 * 3, 0.0), weights(8, 0.0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint32_t label = result.labels[i];
    weights[label] += points.weights[i];
    for (std::size_t d = 0; d < 3; ++d) {
      sums[label * 3 + d] += static_cast<double>(points.weights[i]) * points[i][d];
    }
  }
  // The last iteration gained less than a thousandth: what it would still move is little.
  double mean_error = 0, total = 0;
  for (std::size_t entry = 0; entry < 8; ++entry) {
    REQUIRE(weights[entry] > 0);
    for (std::size_t d = 0; d < 3; ++d) {
      const double off = sums[entry * 3 + d] / weights[entry] - result.centroids[entry * 3 + d];
      mean_error += weights[entry] * off * off;
    }
    total += weights[entry];
  }
  CHECK(mean_error / total <= 1.001e-3 * result.mean_squared_error);
}

bool same(const KMeansResult& a, const KMeansResult& b) {
  return a.centroids == b.centroids && a.labels == b.labels && a.iterations == b.iterations &&
         a.mean_squared_error == b.mean_squared_error;
}

TEST_CASE("k-means: the error that is reported never rises") {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U}) {
    const PointSet points = clustered(seed, 4000, 3, 30);
    double last = std::numeric_limits<double>::infinity();
    std::uint32_t calls = 0;
    const KMeansResult result =
        kmeans(points, config_of(64, 100, seed), [&](std::uint32_t iteration, double error) {
          CHECK(iteration == calls++);
          CHECK(error <= last * (1 + 1e-6));
          last = error;
        });
    CHECK(calls >= result.iterations);
    CHECK(result.iterations > 1);
    CHECK(result.mean_squared_error <= last * (1 + 1e-6));
  }
}

// Lloyd without re-seeding, from given centroids; returns the mean squared error it ends with and
// how many entries have no point by then.
struct PlainLloyd {
  double mean_squared_error = 0;
  int empty = 0;
};
PlainLloyd plain_lloyd(const PointSet& points, std::vector<float> centroids) {
  const auto dims = static_cast<std::size_t>(points.dims);
  PlainLloyd out;
  constexpr int kIterations = 50;
  for (int k = 0; k < kIterations; ++k) {
    const auto search = make_exhaustive_search(centroids, points.dims);
    std::vector<double> sums(centroids.size(), 0.0);
    std::vector<int> members(centroids.size() / dims, 0);
    out.mean_squared_error = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Nearest nearest = search->find(points[i], 0);
      ++members[nearest.index];
      out.mean_squared_error += nearest.squared_distance / static_cast<double>(points.size());
      for (std::size_t d = 0; d < dims; ++d) sums[nearest.index * dims + d] += points[i][d];
    }
    out.empty = static_cast<int>(std::count(members.begin(), members.end(), 0));
    for (std::size_t c = 0; c < centroids.size(); ++c) {
      if (members[c / dims] > 0) centroids[c] = static_cast<float>(sums[c] / members[c / dims]);
    }
  }
  return out;
}

TEST_CASE("k-means: entries that plain Lloyd leaves without points are put to use") {
  struct Found {  // by trying some ten thousand
    int dims, points;
    std::uint32_t entries;
    std::uint64_t seed;
  };
  for (const Found& found : {Found{1, 12, 5, 1095},
                             {1, 40, 15, 1368},
                             {2, 20, 8, 2916},
                             {2, 40, 15, 2380},
                             {3, 12, 5, 2314}}) {
    INFO("seed " << found.seed);
    Random random(found.seed);
    PointSet points{found.dims, {}, {}};
    for (int i = 0; i < found.points * found.dims; ++i) {
      points.values.push_back(uniform(random, -1, 1));
    }
    points.weights.assign(static_cast<std::size_t>(found.points), 1);
    const PlainLloyd plain =
        plain_lloyd(points, kmeans(points, config_of(found.entries, 0, found.seed)).centroids);
    CHECK(plain.empty > 0);
    const KMeansResult result = kmeans(points, config_of(found.entries, 50, found.seed));
    std::vector<int> members(found.entries, 0);
    for (const std::uint32_t label : result.labels) ++members[label];
    CHECK(std::count(members.begin(), members.end(), 0) == 0);
    CHECK(result.mean_squared_error < plain.mean_squared_error);
  }
}

TEST_CASE("k-means: an entry without weight goes to the worst-served point") {
  // Whatever is seeded: once an entry's only points have weight 0 it counts as empty. Three heavy
  // points close together and a light one far away need the entries that they get.
  const PointSet points{1, {0, 1, 2, 1000, 500, 501}, {1e6F, 1e6F, 1e6F, 1, 0, 0}};
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const KMeansResult result = kmeans(points, config_of(4, 50, seed));
    CHECK(result.mean_squared_error == 0);
    CHECK(result.centroids[result.labels[3]] == 1000);
  }
}

TEST_CASE("k-means: no more distinct points than entries are the codebook, without error") {
  for (const std::uint32_t distinct : {1U, 2U, 49U, 50U}) {
    PointSet points{3, {}, {}};
    for (std::uint32_t i = 0; i < 1000; ++i) {
      const auto value = 0.1F * static_cast<float>(i % distinct);
      points.values.insert(points.values.end(), {value, -value, 1});
      points.weights.push_back(static_cast<float>(i % 3));
    }
    const KMeansResult result = kmeans(points, config_of(50, 20));
    CHECK(result.entries(3) == distinct);
    CHECK(result.mean_squared_error == 0);
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (std::size_t d = 0; d < 3; ++d) {
        REQUIRE(result.centroids[result.labels[i] * 3 + d] == points[i][d]);
      }
    }
  }
}

TEST_CASE("k-means: nothing, and one point") {
  const KMeansResult nothing = kmeans({3, {}, {}}, config_of(16, 20));
  CHECK(nothing.entries(3) == 0);
  CHECK(nothing.labels.empty());
  const KMeansResult one = kmeans({3, {1, 2, 3}, {0}}, config_of(16, 20));
  CHECK(one.centroids == std::vector<float>{1, 2, 3});
  CHECK(one.labels == std::vector<std::uint32_t>{0});
}

TEST_CASE("k-means: weights of 0 for all count as equal weights") {
  PointSet points = clustered(8, 500, 2, 10);
  points.weights.assign(points.size(), 0);
  const KMeansResult weightless = kmeans(points, config_of(20, 20));
  points.weights.assign(points.size(), 1);
  CHECK(same(kmeans(points, config_of(20, 20)), weightless));
  CHECK(weightless.entries(2) == 20);

  // Also where only some of the points are drawn for training.
  points.weights.assign(points.size(), 0);
  KMeansConfig drawn = config_of(20, 20);
  drawn.training_points = 100;
  CHECK(kmeans(points, drawn).entries(2) == 20);
}

TEST_CASE("k-means: weights from the smallest to the largest float") {
  PointSet points = clustered(10, 500, 2, 10);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points.weights[i] =
        i % 2 == 0 ? std::numeric_limits<float>::max() : std::numeric_limits<float>::denorm_min();
  }
  const KMeansResult result = kmeans(points, config_of(20, 20));
  CHECK(result.entries(2) == 20);
  CHECK(std::isfinite(result.mean_squared_error));
  check_labels(points, result);
}

TEST_CASE("k-means: values whose squares overflow get entries, the others are served") {
  PointSet points = clustered(11, 2000, 3, 16);
  const KMeansResult without = kmeans(points, config_of(16, 20));
  for (const float huge : {1e30F, -1e30F, 3e38F}) {
    points.values.insert(points.values.end(), {huge, 0, 1});
    points.weights.push_back(1000);
  }
  const KMeansResult result = kmeans(points, config_of(19, 20));
  double error = 0, weight = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float* centroid = &result.centroids[result.labels[i] * 3];
    if (i >= 2000) {
      CHECK(centroid[0] == points[i][0]);
      continue;
    }
    error += points.weights[i] * squared_distance(points[i], centroid, 3);
    weight += points.weights[i];
  }
  CHECK(result.iterations > 1);
  CHECK(error / weight < 1.5 * without.mean_squared_error);
}

}  // namespace
}  // namespace sgs
