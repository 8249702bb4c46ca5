// The chunk tree: every Gaussian stored once, chunks within their size, parents around their
// children, the same whatever the number of threads.
#include "algorithm/voxel/chunk_tree.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstring>

#include "algorithm/splat/activate.h"
#include "algorithm/splat/footprint.h"
#include "testbench/builtin/builtin_scene.h"
#include "tests/algorithm/voxel/chunk_bound_checks.h"
#include "tests/algorithm/voxel/hard_scenes.h"

using namespace sgs;
using sgs::test::holds;

namespace {

struct Shape {
  std::uint32_t next_slot = 0, chunks = 0, depth = 0;
  std::vector<bool> node_seen;
};

// The true bound of the Gaussians of one chunk, which must begin where the one before ended.
ChunkBound check_chunk(const ActivatedCloud& cloud, const Arrangement<ChunkTree>& arrangement,
                       std::uint32_t slot, std::uint32_t count, Shape& shape) {
  ++shape.chunks;
  REQUIRE(slot == shape.next_slot);
  shape.next_slot = slot + count;
  REQUIRE(shape.next_slot <= arrangement.storage_order.size());
  const auto first = arrangement.storage_order.begin() + slot;
  REQUIRE(std::is_sorted(first, first + count));
  ChunkBound bound = gaussian_bound(cloud.gaussians[*first]);
  for (auto it = first; it != first + count; ++it) {
    bound = merged(bound, gaussian_bound(cloud.gaussians[*it]));
  }
  return bound;
}

// Walks a node and what is below it; the true bound of its Gaussians. A node's own chunks lie
// before those of its inner children.
ChunkBound check_node(const ActivatedCloud& cloud, const Arrangement<ChunkTree>& arrangement,
                      std::uint32_t at, std::uint32_t chunk, std::uint32_t level, Shape& shape) {
  const ChunkTree& tree = arrangement.table;
  REQUIRE(at < tree.nodes.size());
  REQUIRE_FALSE(shape.node_seen[at]);
  shape.node_seen[at] = true;
  shape.depth = std::max(shape.depth, level);
  const ChunkNode& node = tree.nodes[at];
  REQUIRE(node.children >= 1);
  REQUIRE(node.children <= kChunkNodeWidth);
  std::vector<ChunkBound> children(node.children);
  std::uint32_t slot = node.first_slot, inner = node.first_node;
  for (std::size_t c = 0; c < node.children; ++c) {
    if (node.count[c] == 0) continue;
    REQUIRE(node.count[c] <= chunk);
    children[c] = check_chunk(cloud, arrangement, slot, node.count[c], shape);
    slot += node.count[c];
  }
  for (std::size_t c = 0; c < node.children; ++c) {
    if (node.count[c] > 0) continue;
    children[c] = check_node(cloud, arrangement, inner++, chunk, level + 1, shape);
  }
  ChunkBound all = children[0];
  for (std::size_t c = 0; c < node.children; ++c) {
    REQUIRE(holds(child_bound(node, static_cast<int>(c)), children[c]));
    all = merged(all, children[c]);
  }
  return all;
}

void check_tree(const ActivatedCloud& cloud, const Arrangement<ChunkTree>& arrangement,
                std::uint32_t chunk, Stored stored) {
  const ChunkTree& tree = arrangement.table;
  std::vector<std::uint32_t> sorted = arrangement.storage_order;
  std::sort(sorted.begin(), sorted.end());
  REQUIRE(sorted == stored_gaussians(cloud, stored));
  if (sorted.empty()) {
    REQUIRE(tree.nodes.empty());
    REQUIRE(tree.chunk_count == 0);
    return;
  }
  Shape shape;
  shape.node_seen.resize(tree.nodes.size());
  check_node(cloud, arrangement, 0, chunk, 1, shape);
  CHECK(shape.next_slot == arrangement.storage_order.size());
  CHECK(shape.chunks == tree.chunk_count);
  CHECK(shape.depth == tree.depth);
  CHECK(
      std::all_of(shape.node_seen.begin(), shape.node_seen.end(), [](bool seen) { return seen; }));
  CHECK(tree.chunk_count >= (sorted.size() + chunk - 1) / chunk);
}

bool same(const Arrangement<ChunkTree>& a, const Arrangement<ChunkTree>& b) {
  const std::vector<ChunkNode>&of_a = a.table.nodes, &of_b = b.table.nodes;
  return a.storage_order == b.storage_order && of_a.size() == of_b.size() &&
         std::memcmp(of_a.data(), of_b.data(), of_a.size() * sizeof(ChunkNode)) == 0;
}

ActivatedCloud hard_cloud(unsigned seed, std::size_t count) {
  return activate(test::HardScenes(seed).next(count, 100).cloud);
}

}  // namespace

TEST_CASE("chunk trees of hard clouds, chunks of 1 to 256") {
  for (unsigned seed = 0; seed < 60; ++seed) {
    const ActivatedCloud cloud = hard_cloud(seed, 1 + seed * 37 % 1500);
    for (const std::uint32_t chunk : {1U, 2U, 3U, 16U, 64U, 255U, 256U}) {
      const Stored stored = seed % 2 == 0 ? Stored::kVisible : Stored::kAll;
      CAPTURE(seed, chunk);
      check_tree(cloud, arrange_by_chunks(cloud, chunk, stored), chunk, stored);
    }
  }
}

TEST_CASE("chunk tree of equal Gaussians: full chunks, logarithmic depth") {
  ActivatedCloud cloud;
  cloud.gaussians.assign(20000, {{1, 2, 3}, glm::vec3(0.1F), {1, 0, 0, 0}, 0.5F});
  const Arrangement<ChunkTree> arrangement = arrange_by_chunks(cloud, 16);
  check_tree(cloud, arrangement, 16, Stored::kVisible);
  const ChunkTree& tree = arrangement.table;
  CHECK(tree.chunk_count == 1250);
  CHECK(tree.depth <= 11);  // 2^11 > 1250: no deeper than a balanced binary tree
}

TEST_CASE("chunk tree is the same with one thread and with many") {
  const ActivatedCloud cloud = activate(make_builtin_scene("builtin:outdoor?n=60000").cloud);
  const Arrangement<ChunkTree> many = arrange_by_chunks(cloud, 16);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  CHECK(same(many, arrange_by_chunks(cloud, 16)));
  check_tree(cloud, many, 16, Stored::kVisible);
}

TEST_CASE("chunk tree: giants do not widen the chunks of small Gaussians") {
  // 990 points and 10 giants among them: the giants have chunks of their own.
  ActivatedCloud cloud;
  for (int i = 0; i < 1000; ++i) {
    const auto at = static_cast<float>(i % 100);
    const float scale = i % 100 == 7 ? 1000.0F : 0.01F;
    cloud.gaussians.push_back(
        {{at, static_cast<float>(i / 100), 0}, glm::vec3(scale), {1, 0, 0, 0}, 0.5F});
  }
  const ChunkTree tree = arrange_by_chunks(cloud, 10).table;
  std::uint32_t wide = 0;
  for (const ChunkNode& node : tree.nodes) {
    for (int c = 0; c < node.children; ++c) {
      wide += node.count[c] > 0 && child_bound(node, c).extent.x > 100 ? 1 : 0;
    }
  }
  CHECK(wide == 1);
}
