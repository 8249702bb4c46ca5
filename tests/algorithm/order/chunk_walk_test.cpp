// The front-to-back walk over the chunk tree, against brute force over all of its nodes, with
// queues that hold everything and queues that hold almost nothing.
#include "algorithm/order/chunk_walk.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <tuple>

#include "algorithm/order/tree_in_memory.h"
#include "algorithm/render/group_state.h"
#include "algorithm/splat/activate.h"
#include "algorithm/voxel/chunk_tree.h"
#include "tests/algorithm/voxel/hard_scenes.h"

using namespace sgs;

namespace {

struct TreeSource : TreeInMemory {
  explicit TreeSource(const ChunkTree& tree) : TreeInMemory{tree, {}} {}
  std::uint64_t nodes_read = 0;

  const ChunkNode& node(std::uint32_t index) {
    ++nodes_read;
    return TreeInMemory::node(index);
  }
};

using Chunk = std::tuple<float, std::uint32_t, std::uint32_t>;  // nearest, slot, count

// Every chunk that touches, below nodes that touch.
void collect(const View<float>& view, const ChunkTree& tree, std::uint32_t at, float nearest,
             const PixelRect& group, std::vector<Chunk>& out) {
  const ChunkNode& node = tree.nodes[at];
  std::uint32_t slot = node.first_slot, inner = node.first_node;
  for (int c = 0; c < node.children; ++c) {
    const ChunkTest test = GroupFrustum(view, group).test(child_bound(node, c));
    const float here = std::max(nearest, test.nearest);
    const std::uint32_t count = node.count[c];
    if (test.touches && count > 0) out.emplace_back(here, slot, count);
    if (test.touches && count == 0) collect(view, tree, inner, here, group, out);
    slot += count;
    inner += count == 0 ? 1 : 0;
  }
}

std::vector<Chunk> expected_chunks(const View<float>& view, const ChunkTree& tree,
                                   const PixelRect& group) {
  std::vector<Chunk> out;
  if (!tree.nodes.empty()) collect(view, tree, 0, 0, group, out);
  std::sort(out.begin(), out.end());
  return out;
}

// Up to `most` chunks; their nearest depths must never decrease.
std::vector<Chunk> walked(ChunkWalk<TreeSource>& walk, const PixelRect& group, bool empty,
                          std::size_t most) {
  std::vector<Chunk> out;
  walk.start(group, empty);
  while (out.size() < most) {
    const std::optional<WalkEntry> chunk = walk.next();
    if (!chunk) break;
    if (!out.empty() && chunk->nearest < std::get<0>(out.back())) FAIL("not front to back");
    out.emplace_back(chunk->nearest, chunk->at, chunk->count);
  }
  return out;
}

constexpr std::size_t kAll = ~std::size_t{0};

struct Scene {
  ChunkTree tree;
  View<float> view;
  std::vector<PixelRect> groups;
};

Scene make_scene(unsigned seed, std::size_t gaussians, std::uint32_t chunk) {
  test::HardScenes hard(seed);
  const test::HardScene scene = hard.next(gaussians, 100);
  return {arrange_by_chunks(activate(scene.cloud), chunk).table, make_view<float>(scene.camera),
          pixel_groups(scene.camera.width, scene.camera.height, 4 * (1 + hard.pick(16)))};
}

}  // namespace

TEST_CASE("walk visits every touching chunk once, front to back, whatever the queue holds") {
  std::uint64_t visited = 0, put_aside = 0;
  for (unsigned seed = 0; seed < 150; ++seed) {
    const Scene scene = make_scene(seed, 1 + seed * 41 % 900, 1 + seed % 8);
    for (const std::size_t capacity : {9U, 10U, 17U, 64U, 100000U}) {
      TreeSource source(scene.tree);
      ChunkWalk<TreeSource> walk(scene.view, source, capacity);
      for (const PixelRect& group : scene.groups) {
        CAPTURE(seed, capacity, group.x0, group.y0);
        std::vector<Chunk> got = walked(walk, group, scene.tree.nodes.empty(), kAll);
        std::sort(got.begin(), got.end());
        const bool equal = got == expected_chunks(scene.view, scene.tree, group);
        REQUIRE(equal);
        REQUIRE(source.aside.empty());
        visited += got.size();
      }
      REQUIRE(walk.counters().queue_max <= capacity);
      REQUIRE(walk.counters().nodes == source.nodes_read);
      put_aside += walk.counters().overflowed;
      if (capacity == 100000) REQUIRE(walk.counters().overflowed == 0);
    }
  }
  CHECK(visited > 100000);
  CHECK(put_aside > 10000);
}

TEST_CASE("walk of a group that ends early leaves nothing to the next group") {
  std::uint64_t left_aside = 0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    const Scene scene = make_scene(seed, 300, 1);
    if (scene.tree.nodes.empty()) continue;
    TreeSource source(scene.tree);
    ChunkWalk<TreeSource> walk(scene.view, source, kChunkNodeWidth + 1);
    for (const PixelRect& group : scene.groups) {
      walked(walk, group, false, seed % 7);
      left_aside += source.aside.size();
      std::vector<Chunk> got = walked(walk, group, false, kAll);
      std::sort(got.begin(), got.end());
      const bool equal = got == expected_chunks(scene.view, scene.tree, group);
      CAPTURE(seed);
      REQUIRE(equal);
    }
  }
  CHECK(left_aside > 100);
}

TEST_CASE("walk of an empty tree ends at once") {
  const ChunkTree tree;
  test::HardScenes hard(1);
  const View<float> view = make_view<float>(hard.next(0, 100).camera);
  TreeSource source(tree);
  ChunkWalk<TreeSource> walk(view, source, 9);
  CHECK(walked(walk, {0, 0, 4, 4}, true, kAll).empty());
  CHECK(walk.counters().nodes == 0);
}

TEST_CASE("walk opens no node farther than the chunk that was asked for") {
  // A row of points away from the camera: the first chunk needs one path through the tree.
  ActivatedCloud cloud;
  for (int i = 0; i < 4096; ++i) {
    cloud.gaussians.push_back(
        {{0, 0, 1 + static_cast<float>(i)}, glm::vec3(1e-3F), {1, 0, 0, 0}, 0.5F});
  }
  const auto [tree, storage_order] = arrange_by_chunks(cloud, 1);
  Camera camera;
  camera.width = camera.height = 4;
  camera.focal_x = camera.focal_y = 4;
  const View<float> view = make_view<float>(camera);
  TreeSource source(tree);
  ChunkWalk<TreeSource> walk(view, source, 512);
  const std::vector<Chunk> first = walked(walk, {0, 0, 4, 4}, false, 1);
  REQUIRE(first.size() == 1);
  CHECK(storage_order[std::get<1>(first[0])] == 0);
  CHECK(walk.counters().nodes <= tree.depth + 1);  // one more where quantised boxes overlap
}
