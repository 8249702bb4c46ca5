// Weighted k-means: the entries of a codebook, out of weighted points in a space of few dimensions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace sgs {

struct PointSet {
  int dims = 0;
  std::vector<float> values;   // [N, dims]
  std::vector<float> weights;  // [N], not negative

  std::size_t size() const { return weights.size(); }
  const float* operator[](std::size_t index) const {
    return values.data() + index * static_cast<std::size_t>(dims);
  }
};

// Points of equal bits made one, their weights added up (to no more than a float holds).
struct DistinctPoints {
  PointSet points;                      // [M], by first occurrence
  std::vector<std::uint32_t> original;  // [N] index of each original point among them
};
DistinctPoints merge_equal(const PointSet& points);

// `count` points drawn in proportion to their weights, which become equal; all of them, as they
// are, when there are no more than that. Systematic sampling: a point of twice the mean weight is
// drawn about twice.
PointSet draw(const PointSet& points, std::size_t count, std::uint64_t seed);

struct KMeansConfig {
  std::uint32_t entries = 4096;
  std::uint32_t iterations = 20;  // Lloyd iterations at most
  std::uint64_t seed = 1;
  std::size_t training_points = 1U << 18;  // drawn by weight for the iterations
};

struct KMeansResult {
  std::vector<float> centroids;       // [K, dims]; K <= entries
  std::vector<std::uint32_t> labels;  // [N] nearest centroid of each point
  double mean_squared_error = 0;      // weighted, of all points
  std::uint32_t iterations = 0;       // made

  std::uint32_t entries(int dims) const {
    return static_cast<std::uint32_t>(centroids.size() / static_cast<std::size_t>(dims));
  }
};

// Called after each iteration with its number and the points' weighted mean squared error.
using KMeansProgress = std::function<void(std::uint32_t iteration, double mean_squared_error)>;

// k-means++ (Arthur and Vassilvitskii 2007) seeding, then Lloyd until an iteration gains less than
// a thousandth or `iterations` are made; an entry that no point is nearest to is put on the point
// that adds most to the error. No more distinct points than entries: they are the codebook, and the
// error is 0. Points of weight 0 do not move entries but get labels; where all weights are 0 all
// count alike. Squared distances beyond the range of float count as its largest number. The same
// result whatever the number of threads.
KMeansResult kmeans(const PointSet& points, const KMeansConfig& config,
                    const KMeansProgress& progress = {});

// The centroids that k-means begins with, by k-means++ (Arthur and Vassilvitskii 2007): [K, dims],
// K <= entries: each next centroid is a point drawn in proportion to weight times squared distance
// to the nearest one so far, until none is left off a centroid. Squared distances beyond the range
// of float count as its largest number. The same result whatever the number of threads.
std::vector<float> seed_centroids(const PointSet& points, std::uint32_t entries,
                                  std::uint64_t seed);

}  // namespace sgs
