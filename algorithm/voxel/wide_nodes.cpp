// The dynamic programme.
#include "algorithm/voxel/wide_nodes.h"

#include <algorithm>
#include <limits>

namespace sgs {
namespace {

double cost_as(const BinaryNode& node, int children) {
  return node.cost_as[static_cast<std::size_t>(children - 1)];
}

// What lies below `node` as `children` of them, from both sides of its cut.
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
