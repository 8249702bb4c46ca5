// Top-down building of the chunk tree, and the test of its bounds for float.
#include "algorithm/voxel/chunk_tree.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "algorithm/splat/visible_extents.h"
#include "algorithm/voxel/binary_tree.h"
#include "algorithm/voxel/chunk_test.h"

namespace sgs {
namespace {

class Builder {
 public:
  Builder(std::vector<ChunkItem>& items, std::uint32_t chunk) : items_(items), chunk_(chunk) {}

  std::unique_ptr<BinaryNode> build(std::uint32_t begin, std::uint32_t end) {
    auto node = std::make_unique<BinaryNode>();
    node->begin = begin;
    node->end = end;
    if (end - begin <= chunk_) {
      node->bound = bound_of(&items_[begin], end - begin);
      return node;
    }
    const std::uint32_t middle = begin + cut_in_two(&items_[begin], end - begin, chunk_);
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
  std::vector<ChunkItem>& items_;
  const std::uint32_t chunk_;
};

// Turns the binary tree into wide nodes and gives chunks their storage slots.
class Widener {
 public:
  Widener(const std::vector<ChunkItem>& items, Arrangement<ChunkTree>& out)
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

  const std::vector<ChunkItem>& items_;
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
  std::vector<ChunkItem> items(kept.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, kept.size(), 4096), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      items[i] = chunk_item(cloud.gaussians[kept[i]], kept[i]);
    }
  });
  out.storage_order.reserve(items.size());
  const auto root =
      Builder(items, chunk_gaussians).build(0, static_cast<std::uint32_t>(items.size()));
  Widener(items, out).run(*root);
  return out;
}

template class GroupFrustumOf<float>;

}  // namespace sgs
