// Weighted points in a space of few dimensions: what k-means works on.
#pragma once

#include <cstddef>
#include <cstdint>
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

}  // namespace sgs
