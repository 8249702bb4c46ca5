// Top-down building of the chunk tree, and the test of its bounds for float.
#include "algorithm/voxel/chunk_tree.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "algorithm/splat/visible_extents.h"
#include "algorithm/voxel/binary_tree.h"
#include "algorithm/voxel/chunk_test.h"

namespace sgs {

namespace {

constexpr int kLevels = kMostExtent;

// Smallest power of two, as exponent, with origin + 255 steps >= high in float.
int step_exponent(float origin, float high) {
  const double width = std::max(0.0, static_cast<double>(high) - origin);
  int exponent = width > 0 ? std::ilogb(width / kLevels) : -126;
  exponent = std::clamp(exponent, -126, 127);
  while (exponent < 127 &&
         origin + static_cast<float>(kLevels) * std::ldexp(1.0F, exponent) < high) {
    ++exponent;
  }
  return exponent;
}

float position(float origin, int q, int exponent) {
  return box_bound(origin, std::ldexp(1.0F, exponent), q);
}

std::uint8_t quantise_low(float value, float origin, int exponent) {
  int q = static_cast<int>(std::clamp(
      std::floor((static_cast<double>(value) - origin) / std::ldexp(1.0, exponent)), 0.0, 255.0));
  while (q > 0 && position(origin, q, exponent) > value) --q;
  return static_cast<std::uint8_t>(q);
}

std::uint8_t quantise_high(float value, float origin, int exponent) {
  int q = static_cast<int>(std::clamp(
      std::ceil((static_cast<double>(value) - origin) / std::ldexp(1.0, exponent)), 0.0, 255.0));
  while (q < kLevels && position(origin, q, exponent) < value) ++q;
  return static_cast<std::uint8_t>(q);
}

float extent_of(int q, int exponent) {
  return extent_value<float>(q, least_extent_exponent(exponent));
}

std::uint8_t quantise_extent(float value, int exponent) {
  if (!(value > 0)) return 0;
  const double below = (exponent - std::log2(static_cast<double>(value))) * kExtentSteps;
  int q = kLevels - static_cast<int>(std::clamp(std::floor(below), 0.0, 255.0));
  while (q < kLevels && extent_of(q, exponent) < value) ++q;
  return static_cast<std::uint8_t>(q);
}

constexpr int kInfiniteExtent = 127;  // exponent that stands for "beyond float"

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

float extent_fraction(int q) {
  static const auto table = [] {
    std::array<float, kExtentSteps> out{};
    for (int k = 0; k < kExtentSteps; ++k) {
      const double octaves = (kExtentSteps - 1 - k) / static_cast<double>(kExtentSteps);
      out[static_cast<std::size_t>(k)] =
          std::nextafter(static_cast<float>(std::exp2(-octaves)), 2.0F);
    }
    return out;
  }();
  return table[static_cast<std::size_t>(q % kExtentSteps)];
}

ChunkBound merged(const ChunkBound& a, const ChunkBound& b) {
  ChunkBound out;
  for (int k = 0; k < 3; ++k) {
    out.low[k] = std::min(a.low[k], b.low[k]);
    out.high[k] = std::max(a.high[k], b.high[k]);
    out.extent[k] = std::max(a.extent[k], b.extent[k]);
  }
  out.scale_max = std::max(a.scale_max, b.scale_max);
  return out;
}

void quantise(const ChunkBound* bounds, ChunkNode& node) {
  ChunkBound all = bounds[0];
  for (int c = 1; c < node.children; ++c) all = merged(all, bounds[c]);
  float largest = all.scale_max;
  for (int k = 0; k < 3; ++k) {
    node.origin[k] = all.low[k];
    node.step_exponent[k] = static_cast<std::int8_t>(step_exponent(all.low[k], all.high[k]));
    largest = std::max(largest, all.extent[k]);
  }
  const int octave = std::isfinite(largest) && largest > 0 ? std::ilogb(largest) + 1 : -100;
  node.extent_exponent = static_cast<std::int8_t>(
      std::isfinite(largest) ? std::clamp(octave, -100, kInfiniteExtent) : kInfiniteExtent);
  for (int c = 0; c < node.children; ++c) {
    for (int k = 0; k < 3; ++k) {
      node.low[c][k] = quantise_low(bounds[c].low[k], node.origin[k], node.step_exponent[k]);
      node.high[c][k] = quantise_high(bounds[c].high[k], node.origin[k], node.step_exponent[k]);
      node.extent[c][k] = quantise_extent(bounds[c].extent[k], node.extent_exponent);
    }
    node.scale[c] = quantise_extent(bounds[c].scale_max, node.extent_exponent);
  }
}

ChunkBound child_bound(const ChunkNode& node, int child) {
  const auto extent = [&](int q) {
    if (node.extent_exponent == kInfiniteExtent) return std::numeric_limits<float>::infinity();
    return extent_of(q, node.extent_exponent);
  };
  ChunkBound out;
  for (int k = 0; k < 3; ++k) {
    out.low[k] = position(node.origin[k], node.low[child][k], node.step_exponent[k]);
    out.high[k] = position(node.origin[k], node.high[child][k], node.step_exponent[k]);
    out.extent[k] = extent(node.extent[child][k]);
  }
  out.scale_max = extent(node.scale[child]);
  return out;
}

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
