// All points against each new centroid: the sums of several blocks of points grow side by side.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <numeric>
#include <random>

#include "algorithm/splat/widest_lanes.h"
#include "algorithm/vq/kmeans.h"

namespace sgs {
namespace {

constexpr std::size_t kBlockPoints =
    2048;                           // points summed in one piece: fixed, so that sums are too
constexpr std::size_t kBlocks = 8;  // blocks side by side

// Row by row of a group of blocks: the points' values, weights and squared distances.
struct Rows {
  const float* values;   // [rows, dims, kBlocks]
  const float* weights;  // [rows, kBlocks]
  float* nearest;        // [rows, kBlocks]
  std::size_t count, dims;
};

// Lowers the squared distances to those to `chosen`; sums: of weight times distance, by lane.
template <std::size_t kDims>
[[gnu::always_inline]] inline void lower_rows(const Rows& rows, const float* chosen, double* sums) {
  const std::size_t dims = kDims > 0 ? kDims : rows.dims;
  double sum[kBlocks] = {};
  for (std::size_t row = 0; row < rows.count; ++row) {
    const float* const values = rows.values + row * dims * kBlocks;
    float squared[kBlocks] = {};
    for (std::size_t d = 0; d < dims; ++d) {
      for (std::size_t lane = 0; lane < kBlocks; ++lane) {
        const float difference = values[d * kBlocks + lane] - chosen[d];
        squared[lane] += difference * difference;
      }
    }
    float* const nearest = rows.nearest + row * kBlocks;
    const float* const weights = rows.weights + row * kBlocks;
    for (std::size_t lane = 0; lane < kBlocks; ++lane) {
      // Infinite distances cannot be compared.
      const float bounded = std::min(squared[lane], std::numeric_limits<float>::max());
      nearest[lane] = std::min(nearest[lane], bounded);
    }
    for (std::size_t lane = 0; lane < kBlocks; ++lane) {
      sum[lane] += static_cast<double>(weights[lane]) * static_cast<double>(nearest[lane]);
    }
  }
  std::copy_n(sum, kBlocks, sums);
}

SGS_WIDEST_LANES
void lower_distances(const Rows& rows, const float* chosen, double* sums) {
  switch (rows.dims) {
    case 2:
      return lower_rows<2>(rows, chosen, sums);
    case 3:
      return lower_rows<3>(rows, chosen, sums);
    case 4:
      return lower_rows<4>(rows, chosen, sums);
    default:
      return lower_rows<0>(rows, chosen, sums);
  }
}

class DrawnPoints {
 public:
  explicit DrawnPoints(const PointSet& points)
      : points_(points),
        dims_(static_cast<std::size_t>(points.dims)),
        rows_(std::min(points.size(), kBlockPoints)),
        groups_((points.size() + kBlockPoints * kBlocks - 1) / (kBlockPoints * kBlocks)),
        values_(groups_ * rows_ * kBlocks * dims_),
        weights_(groups_ * rows_ * kBlocks),
        nearest_(weights_.size(), 1.0F),
        sums_(groups_ * kBlocks) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::size_t at = place_of(i), row = at / kBlocks, lane = at % kBlocks;
      weights_[at] = points.weights[i];
      for (std::size_t d = 0; d < dims_; ++d) {
        values_[(row * dims_ + d) * kBlocks + lane] = points[i][d];
      }
    }
    total_ = std::accumulate(points.weights.begin(), points.weights.end(), 0.0);
  }

  double total() const { return total_; }

  // The first time by weight alone.
  std::size_t draw(double share) {
    if (!first_) return point_at(share * total_);
    first_ = false;
    const std::size_t point = point_at_exactly(share * total_);
    std::fill(nearest_.begin(), nearest_.end(), std::numeric_limits<float>::max());
    return point;
  }

  void add(const float* chosen) {
    tbb::parallel_for(std::size_t{0}, groups_, [&](std::size_t group) {
      const std::size_t at = group * rows_ * kBlocks;
      const Rows rows{&values_[at * dims_], &weights_[at], &nearest_[at], rows_, dims_};
      lower_distances(rows, chosen, &sums_[group * kBlocks]);
    });
    total_ = std::accumulate(sums_.begin(), sums_.end(), 0.0);
  }

 private:
  std::size_t place_of(std::size_t point) const {
    const std::size_t block = point / kBlockPoints, group = block / kBlocks;
    return (group * rows_ + point % kBlockPoints) * kBlocks + block % kBlocks;
  }
  double mass(std::size_t point) const {
    const std::size_t at = place_of(point);
    return static_cast<double>(weights_[at]) * static_cast<double>(nearest_[at]);
  }

  // The point at which the running sum of masses passes `target`; the last of any mass for
  // rounding.
  std::size_t point_at_exactly(double target) const {
    std::size_t last = 0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const double of_point = mass(i);
      if (of_point <= 0) continue;
      last = i;
      target -= of_point;
      if (target < 0) break;
    }
    return last;
  }
  // The same, by the sums of blocks: where rounding could decide, all is summed.
  std::size_t point_at(double target) const {
    const double doubt = total_ * static_cast<double>(points_.size()) * 0x1p-50;
    double left = target;
    for (std::size_t begin = 0; begin < points_.size(); begin += kBlockPoints) {
      if (left - sums_[begin / kBlockPoints] >= doubt) {
        left -= sums_[begin / kBlockPoints];
        continue;
      }
      const std::size_t end = std::min(points_.size(), begin + kBlockPoints);
      for (std::size_t i = begin; i < end; ++i) {
        left -= mass(i);
        if (left < doubt) return left < -doubt ? i : point_at_exactly(target);
      }
    }
    return point_at_exactly(target);
  }

  const PointSet& points_;
  const std::size_t dims_, rows_, groups_;
  // Points that fill up the last group have no weight.
  std::vector<float> values_, weights_, nearest_;
  std::vector<double> sums_;  // [blocks]
  double total_ = 0;
  bool first_ = true;
};

}  // namespace

std::vector<float> seed_centroids(const PointSet& points, std::uint32_t entries,
                                  std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  DrawnPoints drawn(points);
  std::vector<float> centroids;
  for (std::uint32_t entry = 0; entry < entries && drawn.total() > 0; ++entry) {
    const float* chosen = points[drawn.draw(uniform())];
    centroids.insert(centroids.end(), chosen, chosen + points.dims);
    drawn.add(chosen);
  }
  return centroids;
}

}  // namespace sgs
