// Binned costs of a cut; the dynamic programme of wide nodes.
#include "algorithm/voxel/binary_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>

#include "algorithm/splat/visible_extents.h"

#ifdef __SSE__
#include <xmmintrin.h>
#endif

namespace sgs {
namespace {

constexpr int kAxes = 4;
constexpr std::size_t kBins = 32;

// Compilers do not find by themselves that four numbers are compared at once here.
using Four [[gnu::vector_size(16)]] = float;

Four four(const float* of) {
  Four out;
  std::memcpy(&out, of, sizeof out);
  return out;
}
Four all_four(float x) { return Four{x, x, x, x}; }
#ifdef __SSE__
// The same selections in one instruction each.
Four least(Four a, Four b) { return _mm_min_ps(b, a); }
Four largest(Four a, Four b) { return _mm_max_ps(b, a); }
#else
Four least(Four a, Four b) { return b < a ? b : a; }
Four largest(Four a, Four b) { return a < b ? b : a; }
#endif

struct Bin {
  Four low, high, reach;
  std::uint32_t count;

  static Bin empty() {
    return {all_four(std::numeric_limits<float>::max()),
            all_four(std::numeric_limits<float>::lowest()), all_four(0.0F), 0};
  }
  void add(const Bin& other) {
    low = least(low, other.low);
    high = largest(high, other.high);
    reach = largest(reach, other.reach);
    count += other.count;
  }
  ChunkBound bound() const {
    return {{low[0], low[1], low[2]},
            {high[0], high[1], high[2]},
            {reach[0], reach[1], reach[2]},
            reach[3]};
  }
};

Bin bin_of(const ChunkItem& item) { return {four(item.at), four(item.at), four(item.reach), 1}; }

Bin all_of(const ChunkItem* items, std::uint32_t count) {
  Bin all = Bin::empty();
  for (std::uint32_t i = 0; i < count; ++i) all.add(bin_of(items[i]));
  return all;
}

struct Cut {
  double cost = std::numeric_limits<double>::max();
  int axis = -1;
  std::uint32_t left = 0;
};

// Along one axis. Most bins of most cuts are empty: those are neither written nor read.
class AxisBins {
 public:
  AxisBins() {}  // bins are made when something falls into them

  void add(std::size_t at, const Bin& one) {
    const std::uint32_t bit = 1U << at;
    if ((filled_ & bit) == 0) {
      bins_[at] = one;
    } else {
      bins_[at].add(one);
    }
    filled_ |= bit;
  }

  // The least of its own cost and those of all cuts between bins.
  Cut better(Cut best, int axis, std::uint32_t chunk) const {
    const auto cost_of = [&](const Bin& part) {
      const std::uint64_t chunks = (std::uint64_t{part.count} + chunk - 1) / chunk;
      return static_cast<double>(chunks) * inflated_area(part.bound());
    };
    std::size_t places[kBins];
    std::size_t count = 0;
    for (std::uint32_t left = filled_; left != 0; left &= left - 1) {
      places[count++] = static_cast<std::size_t>(__builtin_ctz(left));
    }
    double right_cost[kBins];  // [place] of that bin and all behind it
    Bin right = Bin::empty();
    for (std::size_t k = count; k-- > 1;) {
      right.add(bins_[places[k]]);
      right_cost[k] = cost_of(right);
    }
    Bin left = Bin::empty();
    for (std::size_t k = 0; k + 1 < count; ++k) {
      left.add(bins_[places[k]]);
      const double cost = cost_of(left) + right_cost[k + 1];
      if (cost < best.cost) best = {cost, axis, left.count};
    }
    return best;
  }

 private:
  std::uint32_t filled_ = 0;
  std::array<Bin, kBins> bins_;
};

Cut best_cut(const ChunkItem* items, std::uint32_t count, std::uint32_t chunk) {
  // No two floats are nearer to each other. Where all are at one place they lie in one bin, which
  // is not cut.
  constexpr double kLeastLength = std::numeric_limits<float>::denorm_min();
  const Bin all = all_of(items, count);
  double scale[kAxes];
  for (int k = 0; k < kAxes; ++k) {
    const double length = static_cast<double>(all.high[k]) - all.low[k];
    scale[k] = kBins / std::max(length, kLeastLength);
  }
  std::array<AxisBins, kAxes> bins;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Bin one = bin_of(items[i]);
    for (int k = 0; k < kAxes; ++k) {
      const auto at =
          static_cast<std::size_t>((static_cast<double>(items[i].at[k]) - all.low[k]) * scale[k]);
      bins[static_cast<std::size_t>(k)].add(std::min(at, kBins - 1), one);
    }
  }
  Cut best;
  for (int k = 0; k < kAxes; ++k) {
    best = bins[static_cast<std::size_t>(k)].better(best, k, chunk);
  }
  return best;
}

}  // namespace

ChunkItem chunk_item(const Gaussian<float>& g, std::uint32_t index) {
  const VisibleExtents visible = visible_extents(g);
  const glm::vec3& e = visible.extent;
  const float size = std::clamp(std::max({e.x, e.y, e.z}), 1e-30F, 1e30F);
  return {
      {g.mean.x, g.mean.y, g.mean.z, std::log2(size)}, {e.x, e.y, e.z, visible.scale_max}, index};
}

ChunkBound bound_of(const ChunkItem* items, std::uint32_t count) {
  return all_of(items, count).bound();
}

std::uint32_t cut_in_two(ChunkItem* items, std::uint32_t count, std::uint32_t chunk) {
  const Cut best = best_cut(items, count, chunk);
  const std::uint32_t wanted = best.axis < 0 ? count / 2 : best.left;  // all alike: any is as good
  std::uint32_t left = std::max<std::uint32_t>(1, (wanted + chunk / 2) / chunk) * chunk;
  if (left >= count) left = (count - 1) / chunk * chunk;
  // A total order, so that the result does not depend on how the range was permuted before.
  const int axis = std::max(best.axis, 0);
  std::nth_element(
      items, items + left, items + count, [axis](const ChunkItem& a, const ChunkItem& b) {
        return a.at[axis] < b.at[axis] || (a.at[axis] == b.at[axis] && a.index < b.index);
      });
  return left;
}

namespace {

double cost_as(const BinaryNode& node, int children) {
  return node.cost_as[static_cast<std::size_t>(children - 1)];
}

// The number of children that the left side of a cut gives to a wide node, and the least cost.
struct Share {
  int left;
  double cost;
};
Share best_share(const BinaryNode& node, int children) {
  Share best{1, std::numeric_limits<double>::infinity()};  // areas may overflow: any share then
  for (int left = 1; left < children; ++left) {
    const double cost = cost_as(*node.left, left) + cost_as(*node.right, children - left);
    if (cost < best.cost) best = {left, cost};
  }
  return best;
}

// As many as `children`, or fewer where more save nothing.
void gather(const BinaryNode& node, int children, std::vector<const BinaryNode*>& out) {
  while (children > 1 && cost_as(node, children) == cost_as(node, children - 1)) --children;
  if (node.leaf() || children == 1) {
    out.push_back(&node);
    return;
  }
  const int left = best_share(node, children).left;
  gather(*node.left, left, out);
  gather(*node.right, children - left, out);
}

}  // namespace

void note_costs(BinaryNode& node) {
  if (node.leaf()) return;  // a chunk takes no node
  const double area = double{inflated_area(node.bound)};
  node.cost_as[0] = area + best_share(node, kChunkNodeWidth).cost;
  for (int children = 2; children < kChunkNodeWidth; ++children) {
    node.cost_as[static_cast<std::size_t>(children - 1)] =
        std::min(cost_as(node, children - 1), best_share(node, children).cost);
  }
}

std::vector<const BinaryNode*> wide_children(const BinaryNode& node) {
  std::vector<const BinaryNode*> out;
  if (node.leaf()) {
    out.push_back(&node);
    return out;
  }
  const int left = best_share(node, kChunkNodeWidth).left;
  gather(*node.left, left, out);
  gather(*node.right, kChunkNodeWidth - left, out);
  return out;
}

}  // namespace sgs
