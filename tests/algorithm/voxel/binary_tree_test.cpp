// Wide nodes: the least area together, against every way there is.
#include "algorithm/voxel/binary_tree.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>
#include <random>

namespace sgs {
namespace {

// leaves: chunks below. Areas at random: nothing says that a child's is less.
std::unique_ptr<BinaryNode> random_tree(std::mt19937_64& random, int leaves) {
  auto node = std::make_unique<BinaryNode>();
  std::uniform_real_distribution<float> size(0.1F, 3.0F);
  node->bound.high = {size(random), size(random), size(random)};
  if (leaves == 1) return node;
  const int left = 1 + static_cast<int>(random() % static_cast<std::uint64_t>(leaves - 1));
  node->left = random_tree(random, left);
  node->right = random_tree(random, leaves - left);
  note_costs(*node);
  return node;
}

double least_area(const BinaryNode& node);

// [k] least area below of all ways to make k children of `node` and what is below it.
std::vector<double> ways(const BinaryNode& node) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  std::vector<double> least{kNone, node.leaf() ? 0 : least_area(node)};
  if (node.leaf()) return least;
  const std::vector<double> left = ways(*node.left), right = ways(*node.right);
  least.resize(left.size() + right.size() - 1, kNone);
  for (std::size_t l = 1; l < left.size(); ++l) {
    for (std::size_t r = 1; r < right.size(); ++r) {
      least[l + r] = std::min(least[l + r], left[l] + right[r]);
    }
  }
  return least;
}

double least_area(const BinaryNode& node) {
  const std::vector<double> left = ways(*node.left), right = ways(*node.right);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t l = 1; l < left.size(); ++l) {
    for (std::size_t r = 1; r < right.size() && l + r <= kChunkNodeWidth; ++r) {
      least = std::min(least, left[l] + right[r]);
    }
  }
  return double{inflated_area(node.bound)} + least;
}

// Of the wide nodes that are made; chunks: counts those below.
double area_made(const BinaryNode& node, int& chunks) {
  double area = double{inflated_area(node.bound)};
  const std::vector<const BinaryNode*> children = wide_children(node);
  CHECK(children.size() >= 2);
  CHECK(children.size() <= kChunkNodeWidth);
  for (const BinaryNode* child : children) {
    if (child->leaf()) {
      ++chunks;
    } else {
      area += area_made(*child, chunks);
    }
  }
  return area;
}

TEST_CASE("wide nodes have the least area of all ways to make them") {
  std::mt19937_64 random(19);
  for (int leaves = 2; leaves <= 40; ++leaves) {
    for (int trial = 0; trial < 5; ++trial) {
      const auto tree = random_tree(random, leaves);
      int chunks = 0;
      const double made = area_made(*tree, chunks);
      CHECK(chunks == leaves);
      CHECK(made == Approx(least_area(*tree)).epsilon(1e-12));
    }
  }
}

TEST_CASE("wide nodes: one chunk is its own only child, eight fit one node") {
  std::mt19937_64 random(7);
  const auto chunk = random_tree(random, 1);
  CHECK(wide_children(*chunk) == std::vector<const BinaryNode*>{chunk.get()});
  for (int trial = 0; trial < 20; ++trial) {
    const auto tree = random_tree(random, 8);
    CHECK(wide_children(*tree).size() == 8);
  }
}

}  // namespace
}  // namespace sgs
