// The queues of a front-to-back walk: the nearest entry goes next and, when there is no room, the
// farthest goes aside.
//
// In hardware an interval heap (van Leeuwen and Wood, "Interval heaps", 1993): a binary tree whose
// nodes hold two entries each, the nearest and the farthest of all below them. An insertion and the
// removal at either end are one pass from the root down; every level has a memory of its own, so
// that operations follow each other through the levels. Here a heap and, for the farthest, a
// search: the entries that come out are the same.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace sgs {

// An entry of the walk's queues.
struct WalkEntry {
  float nearest = 0;        // no Gaussian below is nearer than this
  std::uint32_t at = 0;     // node, or first storage slot of a chunk
  std::uint16_t count = 0;  // Gaussians of a chunk; 0: a node
  std::uint16_t walk = 0;   // that it belongs to, numbered modulo 65,536
};

// By walk, then nearest first. Nodes before chunks of the same depth: a chunk is handed out only
// when nothing nearer can follow. Of all numbers in use, none is 32,768 or more behind another.
inline bool walks_before(const WalkEntry& a, const WalkEntry& b) {
  if (a.walk != b.walk) return static_cast<std::int16_t>(a.walk - b.walk) < 0;
  if (a.nearest != b.nearest) return a.nearest < b.nearest;
  if ((a.count == 0) != (b.count == 0)) return a.count == 0;
  return a.at < b.at;
}

// Levels of an interval heap for so many entries.
constexpr std::uint32_t interval_heap_levels(std::uint64_t entries) {
  std::uint32_t levels = 0;
  for (std::uint64_t nodes = (entries + 1) / 2; nodes > 0; nodes /= 2) ++levels;
  return levels;
}

class WalkQueue {
 public:
  // capacity: entries, at least 1.
  explicit WalkQueue(std::size_t capacity) : capacity_(capacity) {}

  bool empty() const { return entries_.empty(); }
  std::size_t capacity() const { return capacity_; }
  std::size_t room() const { return capacity_ - entries_.size(); }
  // Most entries that it ever held.
  std::size_t most() const { return most_; }
  // Insertions and removals so far.
  std::uint64_t pushes() const { return pushes_; }
  std::uint64_t takes() const { return takes_; }

  // Of one that is not empty.
  const WalkEntry& nearest() const { return entries_.front(); }
  const WalkEntry& farthest() const { return *find_farthest(); }

  // Only where there is room.
  void push(const WalkEntry& entry) {
    entries_.push_back(entry);
    std::push_heap(entries_.begin(), entries_.end(), behind);
    most_ = std::max(most_, entries_.size());
    ++pushes_;
  }

  WalkEntry take_nearest() {
    std::pop_heap(entries_.begin(), entries_.end(), behind);
    const WalkEntry entry = entries_.back();
    entries_.pop_back();
    ++takes_;
    return entry;
  }

  WalkEntry take_farthest() {
    const auto at = find_farthest();
    const WalkEntry entry = *at;
    entries_.erase(at);
    std::make_heap(entries_.begin(), entries_.end(), behind);
    ++takes_;
    return entry;
  }

 private:
  static bool behind(const WalkEntry& a, const WalkEntry& b) { return walks_before(b, a); }
  std::vector<WalkEntry>::const_iterator find_farthest() const {
    return std::max_element(entries_.begin(), entries_.end(), walks_before);
  }

  const std::size_t capacity_;
  std::vector<WalkEntry> entries_;  // heap, nearest first
  std::size_t most_ = 0;
  std::uint64_t pushes_ = 0, takes_ = 0;
};

}  // namespace sgs
