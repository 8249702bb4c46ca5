// The queues of a front-to-back walk: the nearest entry goes next and, when there is no room, the
// farthest goes aside.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "algorithm/order/interval_heap.h"
#include "algorithm/splat/extent_bound.h"

namespace sgs {

// An entry of the walk's queues.
struct WalkEntry {
  float nearest = 0;        // no Gaussian below is nearer than this
  std::uint32_t at = 0;     // node, or first storage slot of a chunk
  std::uint16_t count = 0;  // Gaussians of a chunk; 0: a node
  std::uint16_t walk = 0;   // the walk it belongs to, numbered modulo 65,536
  GroupReach reach{};       // nothing below changes any other sub-tile
};

// By walk, then nearest first. Nodes before chunks of the same depth: a chunk is handed out only
// when nothing nearer can follow. Of all numbers in use, none is 32,768 or more behind another.
inline bool walks_before(const WalkEntry& a, const WalkEntry& b) {
  if (a.walk != b.walk) return static_cast<std::int16_t>(a.walk - b.walk) < 0;
  if (a.nearest != b.nearest) return a.nearest < b.nearest;
  if ((a.count == 0) != (b.count == 0)) return a.count == 0;
  return a.at < b.at;
}

struct WalksBefore {
  bool operator()(const WalkEntry& a, const WalkEntry& b) const { return walks_before(a, b); }
};

class WalkQueue {
 public:
  // capacity: entries, at least 1.
  explicit WalkQueue(std::size_t capacity) : heap_(capacity) {}

  bool empty() const { return heap_.empty(); }
  std::size_t capacity() const { return heap_.capacity(); }
  std::size_t room() const { return heap_.capacity() - heap_.size(); }
  // Most entries that it ever held.
  std::size_t most() const { return most_; }
  const HeapWork& work() const { return heap_.work(); }

  // Both need a queue that is not empty.
  const WalkEntry& nearest() const { return heap_.min(); }
  const WalkEntry& farthest() const { return heap_.max(); }

  // Only where there is room.
  void push(const WalkEntry& entry) {
    heap_.insert(entry);
    most_ = std::max(most_, heap_.size());
  }
  WalkEntry take_nearest() { return heap_.delete_min(); }
  WalkEntry take_farthest() { return heap_.delete_max(); }

 private:
  IntervalHeap<WalkEntry, WalksBefore> heap_;
  std::size_t most_ = 0;
};

}  // namespace sgs
