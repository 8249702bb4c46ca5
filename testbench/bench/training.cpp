// Lloyd, Hamerly's bounds, mini-batches.
#include "testbench/bench/training.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <random>

#include "algorithm/vq/nearest.h"

namespace sgs::bench {
namespace {

constexpr std::size_t kGrain = 2048;

float squared_distance(const float* a, const float* b, std::size_t dims) {
  float sum = 0;
  for (std::size_t d = 0; d < dims; ++d) sum += (a[d] - b[d]) * (a[d] - b[d]);
  return sum;
}

template <class OfPoint>
void for_points(std::size_t count, OfPoint&& of_point) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, kGrain), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) of_point(i);
  });
}

double assign(const PointSet& points, const std::vector<float>& centroids,
              std::vector<std::uint32_t>& labels) {
  const auto search = make_exhaustive_search(centroids, points.dims);
  std::vector<float> squared(points.size());
  for_points(points.size(), [&](std::size_t i) {
    const Nearest nearest = search->find(points[i], labels[i]);
    labels[i] = nearest.index;
    squared[i] = nearest.squared_distance;
  });
  double sum = 0;
  for (const float one : squared) sum += one;
  return sum / static_cast<double>(points.size());
}

void move(const PointSet& points, const std::vector<std::uint32_t>& labels,
          std::vector<float>& centroids) {
  const auto dims = static_cast<std::size_t>(points.dims);
  std::vector<double> sums(centroids.size(), 0.0), members(centroids.size() / dims, 0.0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    ++members[labels[i]];
    for (std::size_t d = 0; d < dims; ++d) sums[labels[i] * dims + d] += points[i][d];
  }
  for (std::size_t c = 0; c < centroids.size(); ++c) {
    if (members[c / dims] > 0) centroids[c] = static_cast<float>(sums[c] / members[c / dims]);
  }
}

// The two nearest of all: what Hamerly's bounds begin from. Blocks of centroids side by side, as in
// the library's search.
class TwoNearest {
 public:
  TwoNearest(const std::vector<float>& centroids, std::size_t dims)
      : dims_(dims), entries_(static_cast<std::uint32_t>(centroids.size() / dims)) {
    for (std::uint32_t begin = 0; begin < entries_; begin += kLanes) {
      for (std::size_t d = 0; d < dims; ++d) {
        for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
          values_.push_back(begin + lane < entries_ ? centroids[(begin + lane) * dims + d]
                                                    : std::numeric_limits<float>::infinity());
        }
      }
    }
  }

  // Returns the nearest; second: squared distance of the next.
  std::uint32_t find(const float* point, float& second) const {
    float best = std::numeric_limits<float>::infinity();
    std::uint32_t index = 0;
    second = best;
    for (std::uint32_t begin = 0; begin < entries_; begin += kLanes) {
      float sums[kLanes] = {};
      const float* values = values_.data() + std::size_t{begin} * dims_;
      if (!add_dims(point, values, second, sums)) continue;
      for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
        if (sums[lane] < best) {
          second = best;
          best = sums[lane];
          index = begin + lane;
        } else {
          second = std::min(second, sums[lane]);
        }
      }
    }
    return index;
  }

 private:
  static constexpr std::uint32_t kLanes = 8;

  // False as soon as all lanes are beyond `most`.
  bool add_dims(const float* point, const float* values, float most, float* sums) const {
    constexpr std::size_t kRun = 15;
    for (std::size_t begin = 0; begin < dims_; begin += kRun) {
      for (std::size_t d = begin; d < std::min(dims_, begin + kRun); ++d) {
        for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
          const float difference = point[d] - values[d * kLanes + lane];
          sums[lane] += difference * difference;
        }
      }
      if (*std::min_element(sums, sums + kLanes) > most) return false;
    }
    return true;
  }

  std::size_t dims_;
  std::uint32_t entries_;
  std::vector<float> values_;
};

// Half the distance of each centroid to its nearest neighbour.
std::vector<double> half_gaps(const std::vector<float>& centroids, std::size_t dims) {
  const std::size_t entries = centroids.size() / dims;
  std::vector<double> gaps(entries);
  tbb::parallel_for(std::size_t{0}, entries, [&](std::size_t a) {
    float least = std::numeric_limits<float>::infinity();
    for (std::size_t b = 0; b < entries; ++b) {
      if (b == a) continue;
      least = std::min(least, squared_distance(&centroids[a * dims], &centroids[b * dims], dims));
    }
    gaps[a] = std::sqrt(static_cast<double>(least)) / 2;
  });
  return gaps;
}

}  // namespace

Training plain_lloyd(const PointSet& points, std::vector<float> centroids,
                     std::uint32_t iterations) {
  Training out;
  std::vector<std::uint32_t> labels(points.size(), 0);
  for (std::uint32_t k = 0; k < iterations; ++k) {
    assign(points, centroids, labels);
    move(points, labels, centroids);
  }
  out.mean_squared_error = assign(points, centroids, labels);
  out.centroids = std::move(centroids);
  return out;
}

Training hamerly(const PointSet& points, std::vector<float> centroids, std::uint32_t iterations) {
  // Distances in 32 bits are off by less than this, relative: a bound must be passed by more.
  constexpr double kRounding = 1e-5;
  const auto dims = static_cast<std::size_t>(points.dims);
  std::vector<std::uint32_t> labels(points.size(), 0);
  std::vector<double> bounds(points.size(), 0.0);  // below the distance to all entries but its own
  std::atomic<std::uint64_t> spared{0};
  for (std::uint32_t k = 0; k < iterations; ++k) {
    const std::vector<double> gaps = half_gaps(centroids, dims);
    const TwoNearest search(centroids, dims);
    for_points(points.size(), [&](std::size_t i) {
      const double own = std::sqrt(
          static_cast<double>(squared_distance(points[i], &centroids[labels[i] * dims], dims)));
      if (own * (1 + kRounding) < std::max(bounds[i], gaps[labels[i]]) * (1 - kRounding)) {
        spared.fetch_add(1, std::memory_order_relaxed);
        return;
      }
      float second;
      labels[i] = search.find(points[i], second);
      bounds[i] = std::sqrt(static_cast<double>(second));
    });
    const std::vector<float> before = centroids;
    move(points, labels, centroids);
    std::vector<double> moved(gaps.size());
    for (std::size_t e = 0; e < moved.size(); ++e) {
      moved[e] = std::sqrt(static_cast<double>(
                     squared_distance(&before[e * dims], &centroids[e * dims], dims))) *
                 (1 + kRounding);
    }
    const auto farthest =
        static_cast<std::size_t>(std::max_element(moved.begin(), moved.end()) - moved.begin());
    double next = 0;  // the farthest of the others
    for (std::size_t e = 0; e < moved.size(); ++e) {
      if (e != farthest) next = std::max(next, moved[e]);
    }
    for_points(points.size(),
               [&](std::size_t i) { bounds[i] -= labels[i] == farthest ? next : moved[farthest]; });
  }
  Training out;
  out.mean_squared_error = assign(points, centroids, labels);
  out.centroids = std::move(centroids);
  out.spared =
      static_cast<double>(spared) / (static_cast<double>(points.size()) * std::max(1U, iterations));
  return out;
}

Training mini_batches(const PointSet& points, std::vector<float> centroids, double enough) {
  constexpr std::size_t kIterations = 20;
  constexpr std::uint32_t kBatchesBetweenLooks = 20;
  const auto dims = static_cast<std::size_t>(points.dims);
  std::mt19937_64 random(1);
  std::vector<double> given(centroids.size() / dims, 0.0);
  std::vector<std::uint32_t> labels(points.size(), 0), batch(kBatchPoints), nearest(kBatchPoints);
  Training out;
  while (out.batches * kBatchPoints < kIterations * points.size()) {
    const auto search = make_exhaustive_search(centroids, points.dims);
    for (std::uint32_t& point : batch) point = static_cast<std::uint32_t>(random() % points.size());
    tbb::parallel_for(std::size_t{0}, kBatchPoints, [&](std::size_t b) {
      nearest[b] = search->find(points[batch[b]], labels[batch[b]]).index;
    });
    for (std::size_t b = 0; b < kBatchPoints; ++b) {
      const std::uint32_t entry = labels[batch[b]] = nearest[b];
      const double rate = 1 / ++given[entry];
      for (std::size_t d = 0; d < dims; ++d) {
        float& value = centroids[entry * dims + d];
        value = static_cast<float>(value + rate * (points[batch[b]][d] - value));
      }
    }
    ++out.batches;
    if (out.batches % kBatchesBetweenLooks != 0) continue;
    out.mean_squared_error = assign(points, centroids, labels);
    if (out.mean_squared_error <= 1.01 * enough) break;
  }
  out.mean_squared_error = assign(points, centroids, labels);
  out.centroids = std::move(centroids);
  return out;
}

}  // namespace sgs::bench
