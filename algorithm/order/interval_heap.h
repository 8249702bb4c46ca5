// A double-ended priority queue that hardware can have: an interval heap (van Leeuwen and Wood,
// "Interval heaps", The Computer Journal 36(3), 1993) whose every operation goes from the root
// down, one level after the other, so that levels work on different operations at once (as the
// P-heap of Bhagwan and Lin, "Fast and scalable priority queue architecture for high-speed network
// switches", INFOCOM 2000).
//
// A node holds an interval, two keys [low, high]; the intervals of its children lie within it, so
// that the root holds the nearest and the farthest key of all. A node also knows how many keys lie
// below each of its children. From these counts follows what memory would have to be searched for
// otherwise: which child has room, and whether a child is empty whatever its memory still holds.
// Setting the root's counts to 0 therefore empties the heap.
//
//   insert      the key takes its place in the interval, what it displaces sinks to a child with
//               room: one node read and written a level
//   delete min  the nearest key leaves a hole, which the nearer of both children's low keys fills
//               and leaves in its turn: both children read, one node written a level. delete max
//               likewise at the high ends
//
// How often an operation may begin: modules/streaminggs/heap_ledger.h.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace sgs {

// Accesses to the memory of one level.
struct HeapLevelWork {
  std::uint64_t nodes_read = 0;        // nodes that hold a key; a node has two keys and two counts
  std::uint64_t nodes_read_ahead = 0;  // beside these, below candidates that do not fill a hole
  std::uint64_t nodes_written = 0;     // at most one an operation
};

// Operations, and the accesses of all levels. The root is in registers, where nothing is counted.
struct HeapWork {
  std::uint64_t inserts = 0, delete_mins = 0, delete_maxs = 0;
  std::uint64_t comparisons = 0;  // comparisons of two keys, at any level
  std::vector<HeapLevelWork> levels;

  std::uint64_t operations() const { return inserts + delete_mins + delete_maxs; }
  HeapLevelWork all_levels() const {
    HeapLevelWork sum;
    for (const HeapLevelWork& level : levels) {
      sum.nodes_read += level.nodes_read;
      sum.nodes_read_ahead += level.nodes_read_ahead;
      sum.nodes_written += level.nodes_written;
    }
    return sum;
  }
};

// Levels of nodes that so many keys take.
inline std::uint32_t heap_levels(std::uint64_t capacity) {
  std::uint32_t levels = 1;
  while (2 * ((std::uint64_t{1} << levels) - 1) < capacity) ++levels;
  return levels;
}

// Nodes of a level, the root's is 0, where levels are filled from above.
inline std::uint64_t heap_nodes(std::uint64_t capacity, std::uint32_t level) {
  const std::uint64_t nodes = (capacity + 1) / 2, above = (std::uint64_t{1} << level) - 1;
  return std::min(std::uint64_t{1} << level, nodes - std::min(nodes, above));
}

// Bits of one of the two counts of a level's nodes: 2 (2^k - 1) keys below, k levels deep. The
// deepest level has none.
inline std::uint32_t heap_count_bits(std::uint64_t capacity, std::uint32_t level) {
  const std::uint32_t levels = heap_levels(capacity);
  return level + 1 < levels ? levels - level : 0;
}

// Before: a strict order of keys, total where the order of what comes out is to be known.
template <class Key, class Before>
class IntervalHeap {
 public:
  // capacity: keys, at least 1.
  explicit IntervalHeap(std::size_t capacity)
      : capacity_(capacity), nodes_((capacity + 1) / 2), room_(nodes_.size()) {
    work_.levels.resize(heap_levels(capacity));
    for (std::size_t at = nodes_.size(); at-- > 0;) {
      room_[at] = at + 1 == nodes_.size() && capacity % 2 == 1 ? 1 : 2;
      for (const std::size_t child : {2 * at + 1, 2 * at + 2}) {
        if (child < nodes_.size()) room_[at] += room_[child];
      }
    }
  }

  std::size_t capacity() const { return capacity_; }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  bool full() const { return size_ == capacity_; }
  const HeapWork& work() const { return work_; }

  // Not of an empty heap.
  const Key& min() const { return nodes_[0].low; }
  const Key& max() const { return size_ == 1 ? nodes_[0].low : nodes_[0].high; }

  // Not into a full heap.
  void insert(Key key) {
    ++work_.inserts;
    std::size_t at = 0, held = size_++;  // keys in the node and below it, so far
    for (std::size_t level = 0;; ++level) {
      Node& node = nodes_[at];
      work_.levels[level].nodes_read += at > 0 && held > 0 ? 1 : 0;
      work_.levels[level].nodes_written += at > 0 ? 1 : 0;
      if (held == 0) {
        node = {std::move(key), {}, {0, 0}};
        return;
      }
      ++work_.comparisons;
      if (before(key, node.low)) std::swap(key, node.low);
      if (held == 1) {
        node.high = std::move(key);
        return;
      }
      ++work_.comparisons;
      if (before(node.high, key)) std::swap(key, node.high);
      const std::size_t side = side_with_room(at);
      held = node.below[side]++;
      at = 2 * at + 1 + side;
    }
  }

  // Not of an empty heap.
  Key delete_min() {
    ++work_.delete_mins;
    return take(0);
  }
  Key delete_max() {
    ++work_.delete_maxs;
    return take(1);
  }

  void clear() { size_ = 0; }

 private:
  struct Node {
    Key low, high;
    std::uint32_t below[2];  // keys in each child and below it
  };

  static bool before(const Key& a, const Key& b) { return Before{}(a, b); }

  // The emptier of the children that have room: it evens out the levels.
  std::size_t side_with_room(std::size_t at) const {
    const Node& node = nodes_[at];
    const std::size_t left = 2 * at + 1, right = left + 1;
    const bool left_has = left < nodes_.size() && node.below[0] < room_[left];
    const bool right_has = right < nodes_.size() && node.below[1] < room_[right];
    return right_has && (!left_has || node.below[1] < node.below[0]) ? 1 : 0;
  }

  std::uint64_t children_with_keys(std::size_t at) const {
    return (nodes_[at].below[0] > 0 ? 1 : 0) + (nodes_[at].below[1] > 0 ? 1 : 0);
  }

  // The key at one end (0: low, 1: high) of a node that holds `held` with what is below it.
  Key& end_of(std::size_t at, std::size_t held, std::size_t end) {
    return end == 0 || held == 1 ? nodes_[at].low : nodes_[at].high;
  }

  Key take(std::size_t end) {
    std::size_t at = 0, held = size_--, level = 0;
    Key taken = end_of(at, held, end);
    for (; held > 2; ++level) {  // the hole is filled from below
      Node& node = nodes_[at];
      std::size_t side = node.below[0] > 0 ? 0 : 1;
      const std::size_t left = 2 * at + 1;
      if (node.below[0] > 0 && node.below[1] > 0) {
        ++work_.comparisons;
        const Key &a = end_of(left, node.below[0], end), &b = end_of(left + 1, node.below[1], end);
        side = (end == 0 ? before(b, a) : before(a, b)) ? 1 : 0;
      }
      const std::size_t other = 1 - side;
      work_.levels[level + 1].nodes_read += node.below[other] > 0 ? 2 : 1;
      if (node.below[other] > 2) {
        work_.levels[level + 2].nodes_read_ahead += children_with_keys(left + other);
      }
      work_.levels[level].nodes_written += at > 0 ? 1 : 0;
      held = node.below[side]--;
      (end == 0 ? node.low : node.high) = end_of(left + side, held, end);
      at = left + side;
    }
    // Two keys: the other one is left alone. One: the node is empty.
    if (held == 2 && end == 0) {
      nodes_[at].low = std::move(nodes_[at].high);
      work_.levels[level].nodes_written += at > 0 ? 1 : 0;
    }
    return taken;
  }

  std::size_t capacity_, size_ = 0;
  std::vector<Node> nodes_;          // breadth first, root at 0
  std::vector<std::uint64_t> room_;  // [node] keys that it and those below it can hold: wires
  HeapWork work_;
};

}  // namespace sgs
