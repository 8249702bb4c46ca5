// Top-down building of the chunk tree.
#include "algorithm/voxel/chunk_tree.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "algorithm/splat/visible_extents.h"
#include "algorithm/voxel/wide_nodes.h"

namespace sgs {
namespace {

// What the builder sorts: a Gaussian's bound and its place along the four axes that may be cut.
struct Item {
  ChunkBound bound;
  float along[4];  // x, y, z, log2 of the largest visible half-extent
  std::uint32_t index;
};

constexpr int kBins = 32;

class Builder {
 public:
  Builder(std::vector<Item>& items, std::uint32_t chunk) : items_(items), chunk_(chunk) {}

  std::unique_ptr<BinaryNode> build(std::uint32_t begin, std::uint32_t end) {
    auto node = std::make_unique<BinaryNode>();
    node->begin = begin;
    node->end = end;
    if (end - begin <= chunk_) {
      node->bound = items_[begin].bound;
      for (std::uint32_t i = begin + 1; i < end; ++i)
        node->bound = merged(node->bound, items_[i].bound);
      return node;
    }
    const std::uint32_t middle = split(begin, end);
    constexpr std::uint32_t kWorthATask = 8192;
    if (end - begin > kWorthATask) {
      tbb::parallel_invoke([&] { node->left = build(begin, middle); },
                           [&] { node->right = build(middle, end); });
    } else {
      node->left = build(begin, middle);
      node->right = build(middle, end);
    }
    node->bound = merged(node->left->bound, node->right->bound);
    note_costs(*node);
    return node;
  }

 private:
  struct Bin {
    ChunkBound bound;
    std::uint32_t count = 0;
    void add(const ChunkBound& b, std::uint32_t n) {
      bound = count == 0 ? b : merged(bound, b);
      count += n;
    }
  };

  std::uint64_t chunks(std::uint64_t count) const { return (count + chunk_ - 1) / chunk_; }

  // Reorders [begin, end) and returns where the right part begins: after a whole number of chunks.
  std::uint32_t split(std::uint32_t begin, std::uint32_t end) {
    float low[4], high[4];
    for (int axis = 0; axis < 4; ++axis) {
      low[axis] = std::numeric_limits<float>::max();
      high[axis] = std::numeric_limits<float>::lowest();
    }
    for (std::uint32_t i = begin; i < end; ++i) {
      for (int axis = 0; axis < 4; ++axis) {
        low[axis] = std::min(low[axis], items_[i].along[axis]);
        high[axis] = std::max(high[axis], items_[i].along[axis]);
      }
    }
    double best_cost = std::numeric_limits<double>::max();
    int best_axis = -1;
    std::uint32_t best_left = 0;
    for (int axis = 0; axis < 4; ++axis) {
      if (!(high[axis] > low[axis])) continue;
      std::array<Bin, kBins> bins;
      const double scale = kBins / (static_cast<double>(high[axis]) - low[axis]);
      for (std::uint32_t i = begin; i < end; ++i) {
        const auto at = static_cast<std::size_t>(
            (static_cast<double>(items_[i].along[axis]) - low[axis]) * scale);
        bins[std::min<std::size_t>(at, kBins - 1)].add(items_[i].bound, 1);
      }
      sweep(bins, axis, best_cost, best_axis, best_left);
    }
    const std::uint32_t count = end - begin;
    if (best_axis < 0) best_left = count / 2;  // all alike: any cut is as good
    std::uint32_t left = static_cast<std::uint32_t>(
        std::max<std::uint64_t>(1, (best_left + chunk_ / 2) / chunk_) * chunk_);
    if (left >= count) left = static_cast<std::uint32_t>((chunks(count) - 1) * chunk_);
    const auto first = items_.begin() + begin;
    // A total order, so that the result does not depend on how the range was permuted before.
    std::nth_element(first, first + left, items_.begin() + end, [&](const Item& a, const Item& b) {
      const int axis = std::max(best_axis, 0);
      return a.along[axis] < b.along[axis] || (a.along[axis] == b.along[axis] && a.index < b.index);
    });
    return begin + left;
  }

  void sweep(const std::array<Bin, kBins>& bins, int axis, double& best_cost, int& best_axis,
             std::uint32_t& best_left) const {
    std::array<double, kBins> right_cost{};
    Bin right;
    for (int k = kBins - 1; k > 0; --k) {
      if (bins[static_cast<std::size_t>(k)].count > 0)
        right.add(bins[static_cast<std::size_t>(k)].bound, bins[static_cast<std::size_t>(k)].count);
      right_cost[static_cast<std::size_t>(k)] =
          right.count == 0 ? -1
                           : static_cast<double>(chunks(right.count)) * inflated_area(right.bound);
    }
    Bin left;
    for (int k = 0; k + 1 < kBins; ++k) {
      if (bins[static_cast<std::size_t>(k)].count > 0)
        left.add(bins[static_cast<std::size_t>(k)].bound, bins[static_cast<std::size_t>(k)].count);
      if (left.count == 0 || right_cost[static_cast<std::size_t>(k) + 1] < 0) continue;
      const double cost = static_cast<double>(chunks(left.count)) * inflated_area(left.bound) +
                          right_cost[static_cast<std::size_t>(k) + 1];
      if (cost < best_cost) {
        best_cost = cost;
        best_axis = axis;
        best_left = left.count;
      }
    }
  }

  std::vector<Item>& items_;
  const std::uint32_t chunk_;
};

// Turns the binary tree into wide nodes and gives chunks their storage slots.
class Widener {
 public:
  Widener(std::vector<Item>& items, Arrangement<ChunkTree>& out)
      : items_(items), tree_(out.table), storage_order_(out.storage_order) {}

  void run(const BinaryNode& root) {
    tree_.nodes.emplace_back();
    fill(0, root, 1);
    number_by_level();
  }

 private:
  void fill(std::uint32_t at, const BinaryNode& from, std::uint32_t level) {
    tree_.depth = std::max(tree_.depth, level);
    std::vector<const BinaryNode*> children = wide_children(from);
    std::vector<ChunkBound> bounds;
    ChunkNode node;
    node.children = static_cast<std::uint8_t>(children.size());
    node.first_slot = static_cast<std::uint32_t>(storage_order_.size());
    node.first_node = static_cast<std::uint32_t>(tree_.nodes.size());
    for (std::size_t c = 0; c < children.size(); ++c) {
      bounds.push_back(children[c]->bound);
      if (!children[c]->leaf()) {
        tree_.nodes.emplace_back();
        continue;
      }
      node.count[c] = static_cast<std::uint16_t>(children[c]->end - children[c]->begin);
      store(*children[c]);
    }
    quantise(bounds.data(), node);
    tree_.nodes[at] = node;
    std::uint32_t inner = node.first_node;
    for (const BinaryNode* child : children) {
      if (!child->leaf()) fill(inner++, *child, level + 1);
    }
  }

  // Breadth first, so that the nodes that every group opens are the first; slots keep the order of
  // the descent, in which neighbours are near.
  void number_by_level() {
    std::vector<ChunkNode> numbered;
    numbered.reserve(tree_.nodes.size());
    numbered.push_back(tree_.nodes[0]);
    for (std::size_t at = 0; at < numbered.size(); ++at) {
      const std::uint32_t first = numbered[at].first_node;
      numbered[at].first_node = static_cast<std::uint32_t>(numbered.size());
      std::uint32_t inner = 0;
      for (int c = 0; c < numbered[at].children; ++c) inner += numbered[at].count[c] == 0 ? 1 : 0;
      for (std::uint32_t k = 0; k < inner; ++k) numbered.push_back(tree_.nodes[first + k]);
    }
    tree_.nodes = std::move(numbered);
  }

  void store(const BinaryNode& leaf) {
    ++tree_.chunk_count;
    const auto first = storage_order_.size();
    for (std::uint32_t i = leaf.begin; i < leaf.end; ++i) {
      storage_order_.push_back(items_[i].index);
    }
    std::sort(storage_order_.begin() + static_cast<std::ptrdiff_t>(first), storage_order_.end());
  }

  std::vector<Item>& items_;
  ChunkTree& tree_;
  std::vector<std::uint32_t>& storage_order_;
};

}  // namespace

float inflated_area(const ChunkBound& b) {
  float size[3];
  for (int a = 0; a < 3; ++a) size[a] = b.high[a] - b.low[a] + 2 * b.extent[a];
  return size[0] * size[1] + size[1] * size[2] + size[2] * size[0];
}

ChunkBound gaussian_bound(const Gaussian<float>& g) {
  const VisibleExtents extents = visible_extents(g);
  return {g.mean, g.mean, extents.extent, extents.scale_max};
}

Arrangement<ChunkTree> arrange_by_chunks(const ActivatedCloud& cloud, std::uint32_t chunk_gaussians,
                                         Stored stored) {
  Arrangement<ChunkTree> out;
  const std::vector<std::uint32_t> kept = stored_gaussians(cloud, stored);
  if (kept.empty()) return out;
  std::vector<Item> items(kept.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, kept.size(), 4096), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      Item& item = items[i];
      item.index = kept[i];
      item.bound = gaussian_bound(cloud.gaussians[item.index]);
      const glm::vec3& e = item.bound.extent;
      for (int a = 0; a < 3; ++a) item.along[a] = item.bound.low[a];
      item.along[3] = std::log2(std::clamp(std::max({e.x, e.y, e.z}), 1e-30F, 1e30F));
    }
  });
  out.storage_order.reserve(items.size());
  const auto root =
      Builder(items, chunk_gaussians).build(0, static_cast<std::uint32_t>(items.size()));
  Widener(items, out).run(*root);
  return out;
}

}  // namespace sgs
