// Descent of the chunk tree in storage order: the chunks that may touch a rectangle of pixels, each
// once. A stack of levels holds the nodes that are left. Which of them have been asked for ahead of
// their turn is kept beside.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "algorithm/voxel/chunk_test.h"
#include "algorithm/voxel/chunk_tree.h"

namespace sgs {

// Which children of a node touch: a bit each.
inline std::uint8_t touching_children(const ChunkNode& node, const GroupFrustum& frustum) {
  std::uint8_t bits = 0;
  for (int c = 0; c < node.children; ++c) {
    if (frustum.touches(child_bound(node, c))) bits = static_cast<std::uint8_t>(bits | 1U << c);
  }
  return bits;
}

// Nodes among the inner children of one node: a bit each, from its first inner child on.
struct InnerNodes {
  std::uint32_t first_node = 0;
  std::uint8_t bits = 0;

  bool empty() const { return bits == 0; }
  std::uint32_t front() const {
    return first_node + static_cast<std::uint32_t>(__builtin_ctz(bits));
  }
  void remove_front() { bits = static_cast<std::uint8_t>(bits & (bits - 1U)); }
};

inline InnerNodes touching_inner(const ChunkNode& node, std::uint8_t touching) {
  InnerNodes inner{node.first_node, 0};
  unsigned number = 0;
  for (int c = 0; c < node.children; ++c) {
    if (node.count[c] > 0) continue;
    if ((touching >> c & 1U) != 0)
      inner.bits = static_cast<std::uint8_t>(inner.bits | 1U << number);
    ++number;
  }
  return inner;
}

class ChunkDescent {
 public:
  // At the root. empty: the tree has no nodes.
  void begin(bool empty) {
    if (!empty) levels_.push_back({{0, 1}, {0, 1}});
  }
  bool done() const { return levels_.empty(); }
  // The node that is opened next.
  std::uint32_t next() const { return levels_.back().left.front(); }

  // Those that nobody has asked for: of the deepest level, and of the deepest that has any. Null:
  // none.
  InnerNodes* unasked_next() {
    return done() || levels_.back().unasked.empty() ? nullptr : &levels_.back().unasked;
  }
  InnerNodes* unasked_above() {
    const auto level = std::find_if(levels_.rbegin(), levels_.rend(),
                                    [](const Level& l) { return !l.unasked.empty(); });
    return level == levels_.rend() ? nullptr : &level->unasked;
  }

  // Opens the next node. Calls visit(first slot, count) for its chunks that touch; its inner
  // children that touch are next. unasked: of these.
  template <class Visit>
  void open(const ChunkNode& node, std::uint8_t touching, const InnerNodes& unasked,
            const Visit& visit) {
    levels_.back().left.remove_front();
    if (levels_.back().left.empty()) levels_.pop_back();
    std::uint32_t slot = node.first_slot;
    for (int c = 0; c < node.children; ++c) {
      if (node.count[c] == 0) continue;
      if ((touching >> c & 1U) != 0) visit(slot, std::uint32_t{node.count[c]});
      slot += node.count[c];
    }
    const InnerNodes inner = touching_inner(node, touching);
    if (!inner.empty()) levels_.push_back({inner, unasked});
  }

 private:
  // Children of one node.
  struct Level {
    InnerNodes left, unasked;
  };

  std::vector<Level> levels_;  // at most as many as the tree has
};

// Calls visit(first slot, count) for every chunk that may touch the rectangle, in storage order.
template <class Visit>
void for_each_touching_chunk(const ChunkTree& tree, const View<float>& view,
                             const PixelRect& pixels, const Visit& visit) {
  const GroupFrustum frustum(view, pixels);
  ChunkDescent descent;
  for (descent.begin(tree.nodes.empty()); !descent.done();) {
    const ChunkNode& node = tree.nodes[descent.next()];
    const std::uint8_t touching = touching_children(node, frustum);
    descent.open(node, touching, touching_inner(node, touching), visit);
  }
}

}  // namespace sgs
