// k-d tree and exhaustive search.
#include "algorithm/vq/nearest.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <numeric>

namespace sgs {
namespace {

constexpr std::uint32_t kLanes = 8;  // centroids compared side by side

// Blocks of kLanes centroids, dimension by dimension, so that a loop over lanes is vector code.
class CentroidBlocks {
 public:
  CentroidBlocks(int dims) : dims_(static_cast<std::size_t>(dims)) {}

  // Adds the centroids `indices`, padded to whole blocks with ones that are never nearest.
  void add(const std::vector<float>& centroids, const std::uint32_t* indices, std::size_t count) {
    for (std::size_t begin = 0; begin < count; begin += kLanes) {
      for (std::size_t d = 0; d < dims_; ++d) {
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
          const bool real = begin + lane < count;
          values_.push_back(real ? centroids[indices[begin + lane] * dims_ + d]
                                 : std::numeric_limits<float>::infinity());
        }
      }
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        indices_.push_back(begin + lane < count ? indices[begin + lane]
                                                : std::numeric_limits<std::uint32_t>::max());
      }
    }
  }

  std::uint32_t size() const { return static_cast<std::uint32_t>(indices_.size() / kLanes); }

  // Best of block `block` and `best`. Of many dimensions the block is left as soon as the first
  // few put all of it too far away.
  template <int kDims>
  void compare(std::uint32_t block, const float* point, Nearest& best) const {
    const std::size_t dims = kDims > 0 ? kDims : dims_;
    constexpr std::size_t kRun = 15;  // dimensions between two looks
    const float* values = values_.data() + block * dims * kLanes;
    float sums[kLanes] = {};
    for (std::size_t begin = 0; begin < dims; begin += kRun) {
      const std::size_t end = kDims > 0 ? dims : std::min(dims, begin + kRun);
      for (std::size_t d = begin; d < end; ++d) {
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
          const float difference = point[d] - values[d * kLanes + lane];
          sums[lane] += difference * difference;
        }
      }
      float least = sums[0];
      for (std::size_t lane = 1; lane < kLanes; ++lane) least = std::min(least, sums[lane]);
      if (least > best.squared_distance) return;
    }
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::uint32_t index = indices_[block * kLanes + lane];
      if (sums[lane] < best.squared_distance ||
          (sums[lane] == best.squared_distance && index < best.index)) {
        best = {index, sums[lane]};
      }
    }
  }

 private:
  std::size_t dims_;
  std::vector<float> values_;           // [blocks, dims, lanes]
  std::vector<std::uint32_t> indices_;  // [blocks, lanes]
};

// The sum of CentroidBlocks::compare, to the bit.
float squared_distance(const float* a, const float* b, std::size_t dims) {
  float sum = 0;
  for (std::size_t d = 0; d < dims; ++d) sum += (a[d] - b[d]) * (a[d] - b[d]);
  return sum;
}

constexpr Nearest kNone{std::numeric_limits<std::uint32_t>::max(),
                        std::numeric_limits<float>::infinity()};

// Where the search begins: at the hint, if it is a centroid.
Nearest first_guess(const std::vector<float>& centroids, std::size_t dims, const float* point,
                    std::uint32_t hint) {
  if (hint >= centroids.size() / dims) return kNone;
  return {hint, squared_distance(point, centroids.data() + hint * dims, dims)};
}

class ExhaustiveSearch : public NearestSearch {
 public:
  ExhaustiveSearch(const std::vector<float>& centroids, int dims)
      : dims_(static_cast<std::size_t>(dims)), centroids_(centroids), blocks_(dims) {
    std::vector<std::uint32_t> all(centroids.size() / static_cast<std::size_t>(dims));
    std::iota(all.begin(), all.end(), 0U);
    blocks_.add(centroids, all.data(), all.size());
  }

  Nearest find(const float* point, std::uint32_t hint) const override {
    Nearest best = first_guess(centroids_, dims_, point, hint);
    for (std::uint32_t block = 0; block < blocks_.size(); ++block) {
      blocks_.compare<0>(block, point, best);
    }
    return best;
  }

 private:
  const std::size_t dims_;
  const std::vector<float> centroids_;
  CentroidBlocks blocks_;
};

// Median cuts along the widest axis, down to leaves of one block.
template <int kDims>
class KdTree : public NearestSearch {
 public:
  explicit KdTree(const std::vector<float>& centroids) : centroids_(centroids), blocks_(kDims) {
    std::vector<std::uint32_t> all(centroids.size() / kDims);
    std::iota(all.begin(), all.end(), 0U);
    build(all.data(), all.size());
  }

  Nearest find(const float* point, std::uint32_t hint) const override {
    Nearest best = first_guess(centroids_, kDims, point, hint);
    std::array<float, kDims> outside{};
    descend(0, point, outside, 0, best);
    return best;
  }

 private:
  struct Node {
    int axis = -1;  // -1: leaf
    float cut = 0;
    std::uint32_t right = 0;  // the left child follows its parent; a leaf: its block
  };

  void build(std::uint32_t* indices, std::size_t count) {
    const std::size_t at = nodes_.size();
    nodes_.emplace_back();
    if (count <= kLanes) {
      nodes_[at].right = blocks_.size();
      blocks_.add(centroids_, indices, count);
      return;
    }
    const auto value = [&](std::uint32_t index, int axis) {
      return centroids_[std::size_t{index} * kDims + static_cast<std::size_t>(axis)];
    };
    int widest = 0;
    float width = -1;
    for (int axis = 0; axis < kDims; ++axis) {
      float low = value(indices[0], axis), high = low;
      for (std::size_t i = 1; i < count; ++i) {
        low = std::min(low, value(indices[i], axis));
        high = std::max(high, value(indices[i], axis));
      }
      if (high - low > width) {
        width = high - low;
        widest = axis;
      }
    }
    const std::size_t half = count / 2;
    std::nth_element(indices, indices + half, indices + count,
                     [&](std::uint32_t a, std::uint32_t b) {
                       const float x = value(a, widest), y = value(b, widest);
                       return x < y || (x == y && a < b);
                     });
    nodes_[at].axis = widest;
    nodes_[at].cut = value(indices[half], widest);
    build(indices, half);
    nodes_[at].right = static_cast<std::uint32_t>(nodes_.size());
    build(indices + half, count - half);
  }

  // outside: distance of the point to the node's cell along each axis; squared: their sum.
  void descend(std::uint32_t at, const float* point, std::array<float, kDims>& outside,
               float squared, Nearest& best) const {
    const Node& node = nodes_[at];
    if (node.axis < 0) {
      blocks_.template compare<kDims>(node.right, point, best);
      return;
    }
    const auto axis = static_cast<std::size_t>(node.axis);
    const float beyond = point[axis] - node.cut;
    const std::uint32_t nearer = beyond < 0 ? at + 1 : node.right;
    const std::uint32_t farther = beyond < 0 ? node.right : at + 1;
    descend(nearer, point, outside, squared, best);
    const float before = outside[axis];
    const float distance = squared - before * before + beyond * beyond;
    // The factor covers the rounding of the sums, so that no tie is missed.
    if (distance * 0.99999F > best.squared_distance) return;
    outside[axis] = beyond;
    descend(farther, point, outside, distance, best);
    outside[axis] = before;
  }

  const std::vector<float> centroids_;
  CentroidBlocks blocks_;
  std::vector<Node> nodes_;
};

}  // namespace

std::unique_ptr<NearestSearch> make_kd_tree(const std::vector<float>& centroids, int dims) {
  switch (dims) {
    case 1:
      return std::make_unique<KdTree<1>>(centroids);
    case 2:
      return std::make_unique<KdTree<2>>(centroids);
    case 3:
      return std::make_unique<KdTree<3>>(centroids);
    case 4:
      return std::make_unique<KdTree<4>>(centroids);
    default:
      return make_exhaustive_search(centroids, dims);
  }
}

std::unique_ptr<NearestSearch> make_exhaustive_search(const std::vector<float>& centroids,
                                                      int dims) {
  return std::make_unique<ExhaustiveSearch>(centroids, dims);
}

std::unique_ptr<NearestSearch> make_search(const std::vector<float>& centroids, int dims) {
  constexpr int kMostTreeDims = 4;
  return dims <= kMostTreeDims ? make_kd_tree(centroids, dims)
                               : make_exhaustive_search(centroids, dims);
}

}  // namespace sgs
