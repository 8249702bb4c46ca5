// Where k-means begins: k-means++ (Arthur and Vassilvitskii 2007).
#pragma once

#include <cstdint>
#include <vector>

#include "algorithm/vq/point_set.h"

namespace sgs {

// [K, dims], K <= entries: each next centroid is a point drawn in proportion to weight times
// squared distance to the nearest one so far, until none is left off a centroid. Squared distances
// beyond the range of float count as its largest number. The same result whatever the number of
// threads.
std::vector<float> seed_centroids(const PointSet& points, std::uint32_t entries,
                                  std::uint64_t seed);

}  // namespace sgs
