// Seeding and iterations of k-means.
#include "algorithm/vq/kmeans.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>
#include <numeric>
#include <random>

#include "algorithm/vq/nearest.h"

namespace sgs {

namespace {

std::uint64_t hash_of(const float* values, int dims) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (int d = 0; d < dims; ++d) {
    hash = (hash ^ __builtin_bit_cast(std::uint32_t, values[d])) * 0x100000001b3U;
    hash ^= hash >> 29;
  }
  return hash;
}

void append(PointSet& to, const float* point, float weight) {
  to.values.insert(to.values.end(), point, point + to.dims);
  to.weights.push_back(weight);
}

constexpr std::size_t kBlock = 2048;  // points summed in one piece: fixed, so that sums are too

// Sum over blocks of points of what `of_block(begin, end)` returns, in the order of the blocks.
template <class OfBlock>
double ordered_sum(std::size_t count, OfBlock&& of_block) {
  std::vector<double> sums((count + kBlock - 1) / kBlock);
  tbb::parallel_for(std::size_t{0}, sums.size(), [&](std::size_t block) {
    sums[block] = of_block(block * kBlock, std::min(count, (block + 1) * kBlock));
  });
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

// Squares that overflow count as the largest number: infinite errors cannot be compared.
float bounded(float squared) { return std::min(squared, std::numeric_limits<float>::max()); }

struct Assignment {
  std::vector<std::uint32_t> labels;     // [N]
  std::vector<float> squared_distances;  // [N]
};

// Labels of the points; returns the weighted mean squared error.
double assign(const PointSet& points, const std::vector<float>& centroids, Assignment& assignment) {
  const std::unique_ptr<NearestSearch> search = make_search(centroids, points.dims);
  const double error = ordered_sum(points.size(), [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i != end; ++i) {
      const Nearest nearest = search->find(points[i], assignment.labels[i]);
      assignment.labels[i] = nearest.index;
      assignment.squared_distances[i] = bounded(nearest.squared_distance);
      sum += static_cast<double>(points.weights[i]) * assignment.squared_distances[i];
    }
    return sum;
  });
  const double weight = std::accumulate(points.weights.begin(), points.weights.end(), 0.0);
  return weight > 0 ? error / weight : 0;
}

// Weighted means of the points of each label. Labels without weight are put on the points that add
// most to the error.
void move_centroids(const PointSet& points, const Assignment& assignment,
                    std::vector<float>& centroids) {
  const auto dims = static_cast<std::size_t>(points.dims);
  const std::size_t entries = centroids.size() / dims;
  std::vector<std::size_t> first(entries + 1, 0);
  for (const std::uint32_t label : assignment.labels) ++first[label + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<std::uint32_t> members(points.size());
  std::vector<std::size_t> next(first.begin(), first.end() - 1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    members[next[assignment.labels[i]]++] = static_cast<std::uint32_t>(i);
  }
  std::vector<std::uint8_t> empty(entries, 0);
  tbb::parallel_for(std::size_t{0}, entries, [&](std::size_t entry) {
    std::vector<double> sums(dims, 0.0);
    double weight = 0;
    for (std::size_t m = first[entry]; m != first[entry + 1]; ++m) {
      const float* point = points[members[m]];
      const double w = points.weights[members[m]];
      weight += w;
      for (std::size_t d = 0; d < dims; ++d) sums[d] += w * point[d];
    }
    empty[entry] = weight > 0 ? 0 : 1;
    if (weight <= 0) return;
    for (std::size_t d = 0; d < dims; ++d) {
      centroids[entry * dims + d] = static_cast<float>(sums[d] / weight);
    }
  });

  const auto missing =
      static_cast<std::size_t>(std::accumulate(empty.begin(), empty.end(), std::size_t{0}));
  if (missing == 0) return;
  std::vector<std::uint32_t> worst(points.size());
  std::iota(worst.begin(), worst.end(), 0U);
  const auto error = [&](std::uint32_t i) {
    return points.weights[i] * assignment.squared_distances[i];
  };
  const std::size_t taken = std::min(missing, worst.size());
  std::partial_sort(worst.begin(), worst.begin() + static_cast<std::ptrdiff_t>(taken), worst.end(),
                    [&](std::uint32_t a, std::uint32_t b) {
                      return error(a) > error(b) || (error(a) == error(b) && a < b);
                    });
  for (std::size_t entry = 0, at = 0; entry < entries && at < taken; ++entry) {
    if (empty[entry] == 0) continue;
    std::copy_n(points[worst[at++]], dims,
                centroids.begin() + static_cast<std::ptrdiff_t>(entry * dims));
  }
}

// Refines the centroids on the training points.
std::uint32_t iterate(const PointSet& training, const KMeansConfig& config,
                      const KMeansProgress& progress, std::vector<float>& centroids) {
  constexpr double kLeastGain = 1e-3;
  Assignment assignment{std::vector<std::uint32_t>(training.size(), 0),
                        std::vector<float>(training.size(), 0)};
  double before = std::numeric_limits<double>::infinity();
  std::uint32_t made = 0;
  while (made < config.iterations) {
    const double error = assign(training, centroids, assignment);
    if (progress) progress(made, error);
    if (error >= before * (1 - kLeastGain)) break;
    before = error;
    move_centroids(training, assignment, centroids);
    ++made;
  }
  return made;
}

}  // namespace

DistinctPoints merge_equal(const PointSet& points) {
  struct Entry {
    std::uint64_t hash;
    std::uint32_t index;
  };
  const std::size_t count = points.size();
  std::vector<Entry> entries(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    entries[i] = {hash_of(points[i], points.dims), static_cast<std::uint32_t>(i)};
  });
  tbb::parallel_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return a.hash < b.hash || (a.hash == b.hash && a.index < b.index);
  });

  // Points of one hash that differ are kept apart from their neighbour in the list; that the same
  // point may then appear twice does no harm.
  std::vector<std::uint32_t> first(count);  // [N] first point with the same values
  const std::size_t bytes = static_cast<std::size_t>(points.dims) * sizeof(float);
  for (std::size_t e = 0; e < count; ++e) {
    const std::uint32_t index = entries[e].index;
    const bool same = e > 0 && entries[e].hash == entries[e - 1].hash &&
                      std::memcmp(points[index], points[entries[e - 1].index], bytes) == 0;
    first[index] = same ? first[entries[e - 1].index] : index;
  }

  DistinctPoints out;
  out.points.dims = points.dims;
  out.original.resize(count);
  std::vector<double> weights;
  for (std::size_t i = 0; i < count; ++i) {
    if (first[i] == i) {
      out.original[i] = static_cast<std::uint32_t>(weights.size());
      out.points.values.insert(out.points.values.end(), points[i], points[i] + points.dims);
      weights.push_back(points.weights[i]);
    } else {
      out.original[i] = out.original[first[i]];
      weights[out.original[i]] += points.weights[i];
    }
  }
  for (const double weight : weights) {
    out.points.weights.push_back(static_cast<float>(
        std::min(weight, static_cast<double>(std::numeric_limits<float>::max()))));
  }
  return out;
}

PointSet draw(const PointSet& points, std::size_t count, std::uint64_t seed) {
  if (points.size() <= count) return points;
  double total = 0;
  for (const float weight : points.weights) total += weight;
  PointSet out;
  out.dims = points.dims;
  std::mt19937_64 random(seed);
  const double step = total / static_cast<double>(count);
  double next = step * (static_cast<double>(random() >> 11) * 0x1p-53), passed = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    passed += points.weights[i];
    for (; next < passed && out.size() < count; next += step) append(out, points[i], 1);
  }
  return out;
}

KMeansResult kmeans(const PointSet& points, const KMeansConfig& config,
                    const KMeansProgress& progress) {
  KMeansResult result;
  if (points.size() == 0) return result;
  DistinctPoints distinct = merge_equal(points);
  if (distinct.points.size() <= config.entries) {
    result.centroids = distinct.points.values;
    result.labels = distinct.original;
    return result;
  }
  std::vector<float>& weights = distinct.points.weights;
  if (std::none_of(weights.begin(), weights.end(), [](float weight) { return weight > 0; })) {
    std::fill(weights.begin(), weights.end(), 1.0F);
  }
  const PointSet training = draw(distinct.points, config.training_points, config.seed);
  constexpr std::size_t kSeedPointsPerEntry = 16;
  const PointSet seeds = draw(training, kSeedPointsPerEntry * config.entries, config.seed + 1);
  result.centroids = seed_centroids(seeds, config.entries, config.seed + 2);
  result.iterations = iterate(training, config, progress, result.centroids);

  Assignment assignment{std::vector<std::uint32_t>(distinct.points.size(), 0),
                        std::vector<float>(distinct.points.size(), 0)};
  result.mean_squared_error = assign(distinct.points, result.centroids, assignment);
  result.labels.resize(points.size());
  tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
    result.labels[i] = assignment.labels[distinct.original[i]];
  });
  return result;
}

}  // namespace sgs
