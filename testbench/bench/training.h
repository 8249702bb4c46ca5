// Ways of training a codebook that are compared with each other: from the same seeds, without
// re-seeding, all weights 1.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "algorithm/vq/point_set.h"

namespace sgs::bench {

struct Training {
  std::vector<float> centroids;
  double mean_squared_error = 0;
  double spared = 0;          // Hamerly: share of the searches that the bounds made needless
  std::uint32_t batches = 0;  // mini-batches made
};

constexpr std::size_t kBatchPoints = 4096;

// A search of every point in each iteration.
Training plain_lloyd(const PointSet& points, std::vector<float> centroids,
                     std::uint32_t iterations);

// Hamerly 2010: a point whose distance to its entry is below a lower bound of that to all others,
// or below half the way to the entry's nearest neighbour, keeps it. The same bits as plain_lloyd.
Training hamerly(const PointSet& points, std::vector<float> centroids, std::uint32_t iterations);

// Sculley 2010: batches drawn at random, each entry moved to the running mean of what it was given,
// until the error of all points is within a hundredth of `enough`, or as many points were looked at
// as by 20 iterations of Lloyd.
Training mini_batches(const PointSet& points, std::vector<float> centroids, double enough);

}  // namespace sgs::bench
