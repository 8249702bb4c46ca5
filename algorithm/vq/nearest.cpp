// k-d tree and exhaustive search.
#include "algorithm/vq/nearest.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <numeric>

#include "algorithm/splat/widest_lanes.h"

namespace sgs {
namespace {

constexpr std::uint32_t kLanes = 16;  // centroids compared side by side

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

  // Best of block `block` and `best`. With many dimensions the block is left as soon as the first
  // few put all of it too far away.
  template <std::size_t kDims>
  [[gnu::always_inline]] void compare(std::uint32_t block, const float* point,
                                      Nearest& best) const {
    const std::size_t dims = kDims > 0 ? kDims : dims_;
    constexpr std::size_t kRun = 15;  // dimensions between two looks
    const float* values = values_.data() + block * dims * kLanes;
    Lanes sums = {};
    for (std::size_t begin = 0; begin < dims; begin += kRun) {
      const std::size_t end = kDims > 0 ? dims : std::min(dims, begin + kRun);
      for (std::size_t d = begin; d < end; ++d) {
        const Lanes difference = point[d] - *reinterpret_cast<const Lanes*>(values + d * kLanes);
        sums += difference * difference;
      }
      const auto near = sums <= best.squared_distance;
      std::int32_t any = 0;
      for (std::size_t lane = 0; lane < kLanes; ++lane) any |= near[lane];
      if (any == 0) return;
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
  // Named to compilers, which by themselves make vectors of dimensions.
  using Lanes
      [[gnu::vector_size(kLanes * sizeof(float)), gnu::aligned(alignof(float)), gnu::may_alias]] =
          float;

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

SGS_WIDEST_LANES
void compare_all(const CentroidBlocks& blocks, const float* point, Nearest& best) {
  for (std::uint32_t block = 0; block < blocks.size(); ++block) {
    blocks.compare<0>(block, point, best);
  }
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
    compare_all(blocks_, point, best);
    return best;
  }

 private:
  const std::size_t dims_;
  const std::vector<float> centroids_;
  CentroidBlocks blocks_;
};

constexpr std::size_t kMostTreeDims = 4;

struct TreeNode {
  int axis = -1;  // -1: leaf
  float cut = 0;
  std::uint32_t right = 0;  // the left child follows its parent; a leaf: its block
};

// A subtree that is still to be searched.
template <std::size_t kDims>
struct TreeVisit {
  std::uint32_t at;
  float squared;                     // the point's distance to the node's cell
  std::array<float, kDims> outside;  // the same along each axis
};

// The nearer child first.
template <std::size_t kDims>
[[gnu::always_inline]] inline void search_tree(const std::vector<TreeNode>& nodes,
                                               const CentroidBlocks& blocks, const float* point,
                                               Nearest& best) {
  TreeVisit<kDims> waiting[32];  // median cuts of less than 2^32 centroids go no deeper
  waiting[0] = {0, 0, {}};
  for (std::size_t count = 1; count > 0;) {
    TreeVisit<kDims> visit = waiting[--count];
    // The factor covers the rounding of the sums, so that no tie is missed.
    if (visit.squared * 0.99999F > best.squared_distance) continue;
    while (nodes[visit.at].axis >= 0) {
      const TreeNode& node = nodes[visit.at];
      const auto axis = static_cast<std::size_t>(node.axis);
      const float beyond = point[axis] - node.cut, before = visit.outside[axis];
      TreeVisit<kDims>& farther = waiting[count++];
      farther = visit;
      farther.at = beyond < 0 ? node.right : visit.at + 1;
      farther.squared = visit.squared - before * before + beyond * beyond;
      farther.outside[axis] = beyond;
      visit.at = beyond < 0 ? visit.at + 1 : node.right;
    }
    blocks.compare<kDims>(nodes[visit.at].right, point, best);
  }
}

SGS_WIDEST_LANES
void search_tree(const std::vector<TreeNode>& nodes, const CentroidBlocks& blocks, std::size_t dims,
                 const float* point, Nearest& best) {
  switch (dims) {
    case 1:
      return search_tree<1>(nodes, blocks, point, best);
    case 2:
      return search_tree<2>(nodes, blocks, point, best);
    case 3:
      return search_tree<3>(nodes, blocks, point, best);
    default:
      return search_tree<kMostTreeDims>(nodes, blocks, point, best);
  }
}

// Median cuts along the widest axis, down to leaves of one block.
class KdTree : public NearestSearch {
 public:
  KdTree(const std::vector<float>& centroids, int dims)
      : dims_(static_cast<std::size_t>(dims)), centroids_(centroids), blocks_(dims) {
    std::vector<std::uint32_t> all(centroids.size() / dims_);
    std::iota(all.begin(), all.end(), 0U);
    build(all.data(), all.size());
  }

  Nearest find(const float* point, std::uint32_t hint) const override {
    Nearest best = first_guess(centroids_, dims_, point, hint);
    search_tree(nodes_, blocks_, dims_, point, best);
    return best;
  }

 private:
  void build(std::uint32_t* indices, std::size_t count) {
    const std::size_t at = nodes_.size();
    nodes_.emplace_back();
    if (count <= kLanes) {
      nodes_[at].right = blocks_.size();
      blocks_.add(centroids_, indices, count);
      return;
    }
    const auto value = [&](std::uint32_t index, std::size_t axis) {
      return centroids_[std::size_t{index} * dims_ + axis];
    };
    std::size_t widest = 0;
    float width = -1;
    for (std::size_t axis = 0; axis < dims_; ++axis) {
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
    nodes_[at].axis = static_cast<int>(widest);
    nodes_[at].cut = value(indices[half], widest);
    build(indices, half);
    nodes_[at].right = static_cast<std::uint32_t>(nodes_.size());
    build(indices + half, count - half);
  }

  const std::size_t dims_;
  const std::vector<float> centroids_;
  CentroidBlocks blocks_;
  std::vector<TreeNode> nodes_;
};

}  // namespace

std::unique_ptr<NearestSearch> make_kd_tree(const std::vector<float>& centroids, int dims) {
  if (dims > static_cast<int>(kMostTreeDims)) return make_exhaustive_search(centroids, dims);
  return std::make_unique<KdTree>(centroids, dims);
}

std::unique_ptr<NearestSearch> make_exhaustive_search(const std::vector<float>& centroids,
                                                      int dims) {
  return std::make_unique<ExhaustiveSearch>(centroids, dims);
}

std::unique_ptr<NearestSearch> make_search(const std::vector<float>& centroids, int dims) {
  return make_kd_tree(centroids, dims);
}

}  // namespace sgs
