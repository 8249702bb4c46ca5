// Front-to-back walk over the chunk tree: the chunks that a pixel group may need, by nearest depth.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "algorithm/voxel/chunk_test.h"

namespace sgs {

// An entry of the walk's queue.
struct WalkEntry {
  float nearest = 0;        // no Gaussian below is nearer than this
  std::uint32_t at = 0;     // node, or first storage slot of a chunk
  std::uint32_t count = 0;  // Gaussians of a chunk; 0: a node
};

// Nodes before chunks of the same depth: a chunk is handed out only when nothing nearer can follow.
inline bool walks_before(const WalkEntry& a, const WalkEntry& b) {
  if (a.nearest != b.nearest) return a.nearest < b.nearest;
  if ((a.count == 0) != (b.count == 0)) return a.count == 0;
  return a.at < b.at;
}

struct WalkCounters {
  std::uint64_t nodes = 0;             // read
  std::uint64_t tests = 0;             // children tested
  std::uint64_t queue_max = 0;         // entries
  std::uint64_t queue_operations = 0;  // entries put in and taken out
  std::uint64_t overflowed = 0;        // entries put aside because the queue was full
};

// Source: `ChunkNode node(std::uint32_t)`; `void put_aside(const WalkEntry&)` keeps what does not
// fit the queue (in VSU: in DRAM) until `std::vector<WalkEntry> take_back()` or, where a group ends
// early, `void forget_aside()`.
template <class Source>
class ChunkWalk {
 public:
  // capacity: entries of the queue, at least kChunkNodeWidth + 1.
  ChunkWalk(const View<float>& view, Source& source, std::size_t capacity)
      : view_(view), source_(source), capacity_(capacity) {}

  // Begins with another group, whether or not the one before came to its end. empty: the tree has
  // no nodes.
  void start(const PixelRect& pixels, bool empty) {
    pixels_ = pixels;
    queue_.clear();
    if (aside_) source_.forget_aside();
    aside_.reset();
    if (!empty) queue_.push_back({});
  }

  // The next chunk, or none. Nearest depths never decrease.
  std::optional<WalkEntry> next() {
    while (true) {
      if (aside_ && (queue_.empty() || walks_before(*aside_, queue_.front()))) bring_back();
      if (queue_.empty()) return std::nullopt;
      std::pop_heap(queue_.begin(), queue_.end(), behind);
      const WalkEntry entry = queue_.back();
      queue_.pop_back();
      ++counters_.queue_operations;
      if (entry.count > 0) return entry;
      expand(entry);
    }
  }

  const WalkCounters& counters() const { return counters_; }

 private:
  static bool behind(const WalkEntry& a, const WalkEntry& b) { return walks_before(b, a); }

  void expand(const WalkEntry& parent) {
    const ChunkNode node = source_.node(parent.at);
    ++counters_.nodes;
    const GroupFrustum frustum(view_, pixels_);
    std::uint32_t slot = node.first_slot, inner = node.first_node;
    for (int c = 0; c < node.children; ++c) {
      const std::uint32_t count = node.count[c];
      const std::uint32_t at = count > 0 ? slot : inner;
      (count > 0 ? slot : inner) += count > 0 ? count : 1;
      ++counters_.tests;
      const ChunkTest test = frustum.test(child_bound(node, c));
      // A child's own box may be quantised to begin a little before its parent's.
      if (test.touches) push({std::max(test.nearest, parent.nearest), at, count});
    }
  }

  void push(const WalkEntry& entry) {
    queue_.push_back(entry);
    ++counters_.queue_operations;
    std::push_heap(queue_.begin(), queue_.end(), behind);
    if (queue_.size() > capacity_) put_aside_farthest();
    counters_.queue_max = std::max<std::uint64_t>(counters_.queue_max, queue_.size());
  }

  void put_aside_farthest() {
    const auto farthest = std::max_element(queue_.begin(), queue_.end(), walks_before);
    if (!aside_ || walks_before(*farthest, *aside_)) aside_ = *farthest;
    source_.put_aside(*farthest);
    ++counters_.overflowed;
    queue_.erase(farthest);
    std::make_heap(queue_.begin(), queue_.end(), behind);
  }

  void bring_back() {
    aside_.reset();
    for (const WalkEntry& entry : source_.take_back()) push(entry);
  }

  const View<float>& view_;
  Source& source_;
  const std::size_t capacity_;
  PixelRect pixels_;
  std::vector<WalkEntry> queue_;    // heap, nearest first
  std::optional<WalkEntry> aside_;  // the nearest of those put aside
  WalkCounters counters_;
};

}  // namespace sgs
