// The front-to-back walk over the chunk tree, against brute force over all of its nodes, with
// queues that hold everything and queues that hold almost nothing, with nodes opened as they are
// needed and ahead of need in any order; and the descent in storage order.
#include "algorithm/order/chunk_walk.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <tuple>

#include "algorithm/order/chunk_descent.h"
#include "algorithm/render/group_state.h"
#include "algorithm/splat/activate.h"
#include "algorithm/voxel/chunk_tree.h"
#include "tests/algorithm/voxel/hard_scenes.h"

using namespace sgs;

namespace {

struct TreeSource : TreeInMemory {
  explicit TreeSource(const ChunkTree& walked) : TreeInMemory{walked, {}} {}
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

struct Scene {
  ChunkTree tree;
  View<float> view;
  std::vector<PixelRect> groups;
};

Scene make_scene(unsigned seed, std::size_t gaussians, std::uint32_t chunk) {
  test::HardScenes hard(seed);
  const test::HardScene scene = hard.next(gaussians, 100);
  return {arrange_by_chunks(activate(scene.cloud), chunk).table, make_view<float>(scene.camera),
          pixel_groups(scene.camera.width, scene.camera.height,
                       {4 * (1 + hard.pick(16)), 4 * (1 + hard.pick(16))})};
}

}  // namespace

// Takes and opens nodes in a random order, ahead of need, with the next group's walk behind this
// one's; groups end early now and then. Chunks of all groups, in the order in which they come.
struct AheadOfNeed {
  std::vector<std::vector<Chunk>> groups;
  std::vector<bool> whole;      // [group] it was walked to its end
  std::uint64_t two_walks = 0;  // nodes opened of a group behind the first
};

AheadOfNeed walked_ahead(const Scene& scene, TreeSource& source, ChunkWalk<TreeSource>& walk,
                         unsigned seed, unsigned leave_one_in) {
  std::mt19937 random(seed);
  const auto one_in = [&](unsigned n) { return n > 0 && random() % n == 0; };
  AheadOfNeed out;
  std::vector<WalkEntry> being_read;
  std::size_t next = 0;
  out.groups.emplace_back();
  while (out.whole.size() < scene.groups.size()) {
    const std::size_t first = out.whole.size();
    const auto end_first = [&](bool whole) {
      walk.end();
      out.whole.push_back(whole);
      out.groups.emplace_back();
    };
    const bool may_begin = walk.begun() == 0 || walk.has_read_ahead();
    if (next < scene.groups.size() && may_begin && (walk.begun() == 0 || one_in(2))) {
      walk.begin(scene.view, scene.groups[next++], scene.tree.nodes.empty());
    }
    if (walk.has_node() && being_read.size() < 6 && (walk.needs_node() || one_in(2))) {
      being_read.push_back(walk.take_node());
    }
    if (!being_read.empty() && one_in(3)) {
      const auto at =
          being_read.begin() + static_cast<std::ptrdiff_t>(random() % being_read.size());
      out.two_walks += at->walk % 65536 > first ? 1 : 0;
      walk.open(*at, source.node(at->at));
      being_read.erase(at);
    }
    if (one_in(2)) {
      if (const std::optional<WalkEntry> chunk = walk.take_chunk()) {
        out.groups.back().emplace_back(chunk->nearest, chunk->at, chunk->count);
      }
    }
    if (walk.exhausted()) {
      end_first(true);
    } else if (one_in(leave_one_in)) {
      end_first(false);
    }
  }
  out.groups.pop_back();
  return out;
}

TEST_CASE("walk: nodes opened ahead and in any order, and two walks at a time, change nothing") {
  std::uint64_t visited = 0, two_walks = 0, put_aside = 0, left = 0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    const Scene scene = make_scene(seed, 1 + seed * 41 % 900, 1 + seed % 8);
    for (const std::size_t capacity : {9U, 17U, 64U, 100000U}) {
      for (const unsigned leave_one_in : {0U, 200U}) {
        CAPTURE(seed, capacity, leave_one_in);
        TreeSource source(scene.tree);
        ChunkWalk<TreeSource> walk(source, {capacity, capacity});
        const AheadOfNeed got = walked_ahead(scene, source, walk, seed, leave_one_in);
        REQUIRE(got.groups.size() == scene.groups.size());
        for (std::size_t g = 0; g < scene.groups.size(); ++g) {
          std::vector<Chunk> expected = expected_chunks(scene.view, scene.tree, scene.groups[g]);
          if (!got.whole[g]) expected.resize(std::min(expected.size(), got.groups[g].size()));
          const bool equal = got.groups[g] == expected;
          REQUIRE(equal);
          visited += expected.size();
          left += got.whole[g] ? 0 : 1;
        }
        REQUIRE(source.aside.empty());
        REQUIRE(walk.node_queue().most() <= capacity);
        REQUIRE(walk.chunk_queue().most() <= capacity);
        two_walks += got.two_walks;
        put_aside += walk.counters().put_aside;
        if (leave_one_in == 0) {
          REQUIRE(walk.counters().nodes == source.nodes_read);
          REQUIRE((capacity < 100000 || walk.counters().put_aside == 0));
          // Whatever went into a queue has come out.
          for (const WalkQueue* queue : {&walk.node_queue(), &walk.chunk_queue()}) {
            const HeapWork& work = queue->work();
            CHECK(work.inserts == work.delete_mins + work.delete_maxs);
          }
        }
      }
    }
  }
  CHECK(visited > 100000);
  CHECK(two_walks > 1000);
  CHECK(put_aside > 10000);
  CHECK(left > 100);
}

TEST_CASE("descent: the chunks that touch, in storage order") {
  std::uint64_t visited = 0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    const Scene scene = make_scene(seed, seed * 41 % 900, 1 + seed % 8);
    for (const PixelRect& group : scene.groups) {
      std::vector<std::pair<std::uint32_t, std::uint32_t>> expected, got;  // slot, count
      for (const auto& [nearest, slot, count] : expected_chunks(scene.view, scene.tree, group)) {
        expected.emplace_back(slot, count);
      }
      std::sort(expected.begin(), expected.end());
      for_each_touching_chunk(
          scene.tree, scene.view, group,
          [&](std::uint32_t slot, std::uint32_t count) { got.emplace_back(slot, count); });
      const bool equal = got == expected;
      REQUIRE(equal);
      visited += got.size();
    }
  }
  CHECK(visited > 10000);
}

TEST_CASE("walk queue: both ends, against a sorted list") {
  std::mt19937 random(7);
  for (const std::size_t capacity : {1U, 2U, 9U, 100U}) {
    WalkQueue queue(capacity);
    std::vector<WalkEntry> sorted;
    std::size_t largest = 0;
    const auto same = [](const WalkEntry& a, const WalkEntry& b) {
      return !walks_before(a, b) && !walks_before(b, a);
    };
    for (std::uint32_t step = 0; step < 2000; ++step) {
      REQUIRE(queue.room() == capacity - sorted.size());
      if (queue.room() > 0 && (sorted.empty() || random() % 2 == 0)) {
        // Numbers of walks pass 65,535.
        const WalkEntry entry{static_cast<float>(random() % 8), step,
                              static_cast<std::uint16_t>(random() % 3),
                              static_cast<std::uint16_t>(65535 + random() % 2)};
        queue.push(entry);
        sorted.insert(std::upper_bound(sorted.begin(), sorted.end(), entry, walks_before), entry);
      } else if (random() % 2 == 0) {
        REQUIRE(same(queue.take_nearest(), sorted.front()));
        sorted.erase(sorted.begin());
      } else {
        REQUIRE(same(queue.farthest(), sorted.back()));
        REQUIRE(same(queue.take_farthest(), sorted.back()));
        sorted.pop_back();
      }
      largest = std::max(largest, sorted.size());
      REQUIRE(queue.empty() == sorted.empty());
      if (!sorted.empty()) REQUIRE(same(queue.nearest(), sorted.front()));
    }
    CHECK(queue.most() == largest);
    const HeapWork& work = queue.work();
    CHECK(work.inserts == work.delete_mins + work.delete_maxs + sorted.size());
  }
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
  ChunkWalk<TreeSource> walk(source, {512, 512});
  walk.begin(view, {0, 0, 4, 4}, false);
  const std::optional<WalkEntry> first = walk.next();
  REQUIRE(first);
  CHECK(storage_order[first->at] == 0);
  CHECK(walk.counters().nodes <= tree.depth + 1);  // one more where quantised boxes overlap
}
