// Front-to-back walk over the chunk tree: the chunks that a pixel group may need, by nearest depth
// (a best-first search, as Hjaltason and Samet, "Distance Browsing in Spatial Databases", 1999).
// Nodes may be opened in any order and ahead of need; which chunks come out, and in which order,
// does not depend on it. A second group's walk can begin before the first has ended.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "algorithm/order/walk_queue.h"
#include "algorithm/voxel/chunk_test.h"
#include "algorithm/voxel/chunk_tree.h"

namespace sgs {

// Entries that fit the queues, each at least kChunkNodeWidth + 1.
struct WalkRoom {
  std::size_t nodes, chunks;
};

struct WalkCounters {
  std::uint64_t nodes = 0;      // opened
  std::uint64_t tests = 0;      // children tested
  std::uint64_t put_aside = 0;  // entries, because their queue was full
};

// Source: `void put_aside(const WalkEntry&)` keeps what does not fit a queue (in VSU: in DRAM)
// until `void take_back(To)`, which gives each to `To(const WalkEntry&)`, which may put some aside
// again; or, where nothing of it is wanted any more, `void forget_aside()`. For next() also
// `ChunkNode node(std::uint32_t)`.
template <class Source>
class ChunkWalk {
 public:
  static constexpr std::uint32_t kWalks = 2;  // under way at a time

  ChunkWalk(Source& source, const WalkRoom& room)
      : source_(source), nodes_(room.nodes), chunks_(room.chunks) {}

  // Begins with another group, behind those that have begun and not ended: at most kWalks. view:
  // outlives the walk. empty: the tree has no nodes.
  void begin(const View<float>& view, const PixelRect& pixels, bool empty) {
    const auto walk = static_cast<std::uint16_t>(first_ + begun_);
    groups_[walk % kWalks] = {&view, pixels};
    ++begun_;
    if (!empty) push({0, 0, 0, walk});
  }
  std::uint32_t begun() const { return begun_; }

  // The first walk has ended, or what is left of it is not wanted: forgets it.
  void end() {
    drop(nodes_);
    drop(chunks_);
    opening_.erase(std::remove_if(opening_.begin(), opening_.end(),
                                  [&](const WalkEntry& entry) { return of_first(entry); }),
                   opening_.end());
    ++first_;
    --begun_;
    if (!aside_) return;
    if (begun_ > 0) {
      bring_back();
    } else {
      aside_.reset();
      source_.forget_aside();
    }
  }

  // The first walk's next chunk, if nothing nearer can come from nodes that are not open yet.
  // Nearest depths never decrease.
  std::optional<WalkEntry> take_chunk() {
    const WalkEntry* chunk = final_chunk();
    while (chunk == nullptr && aside_is_next()) {
      bring_back();
      chunk = final_chunk();
    }
    if (chunk == nullptr) return std::nullopt;
    return chunks_.take_nearest();
  }
  // True if take_chunk() would give one without the entry put aside.
  bool has_chunk() const { return final_chunk() != nullptr; }
  // The first walk gives no chunk any more.
  bool exhausted() const {
    return !(!nodes_.empty() && of_first(nodes_.nearest())) &&
           !(!chunks_.empty() && of_first(chunks_.nearest())) && !(aside_ && of_first(*aside_)) &&
           std::none_of(opening_.begin(), opening_.end(),
                        [&](const WalkEntry& entry) { return of_first(entry); });
  }

  // The nearest node that is not open, to be read and given to open(); whichever was taken first
  // need not be opened first.
  bool has_node() const { return !nodes_.empty(); }
  WalkEntry take_node() {
    opening_.push_back(nodes_.take_nearest());
    return opening_.back();
  }
  // The entry that take_node() would give; only where there is one.
  const WalkEntry& next_node() const { return nodes_.nearest(); }
  // The next node is of the first walk, and nothing is being read that could give a chunk.
  bool needs_node() const {
    return opening_.empty() && !nodes_.empty() && of_first(nodes_.nearest()) && !has_chunk();
  }
  // The children of the nodes that are being read, and of one more, are sure to fit. A quarter of
  // each queue is left to nodes of the first walk that are read while it can give no chunk.
  bool has_room_for_another() const { return nodes_have_room() && chunks_have_room(); }
  bool nodes_have_room() const { return has_room_for_another(nodes_); }
  bool chunks_have_room() const { return has_room_for_another(chunks_); }
  // All nodes of the walks that have begun are open or being read: another may begin.
  bool has_read_ahead() const { return begun_ < kWalks && nodes_.empty() && !aside_; }

  // A node that was taken is not wanted: as if nothing below touched its group.
  void leave_out(const WalkEntry& entry) {
    opening_.erase(std::find_if(opening_.begin(), opening_.end(), [&](const WalkEntry& e) {
      return e.at == entry.at && e.walk == entry.walk;
    }));
  }
  // True if the walk of a taken entry has ended.
  bool has_ended(const WalkEntry& entry) const {
    return static_cast<std::int16_t>(entry.walk - first_) < 0;
  }
  // True if an entry belongs to the walk that began first.
  bool of_first(const WalkEntry& entry) const { return entry.walk == first_; }

  // entry: as take_node() gave it. Its walk may have ended meanwhile.
  void open(const WalkEntry& entry, const ChunkNode& node) {
    const auto same = std::find_if(opening_.begin(), opening_.end(), [&](const WalkEntry& e) {
      return e.at == entry.at && e.walk == entry.walk;
    });
    if (same == opening_.end()) return;
    opening_.erase(same);
    expand(entry, node);
  }

  // The first walk's next chunk, or none, opening the nodes that it needs and no others.
  std::optional<WalkEntry> next() {
    while (true) {
      if (const std::optional<WalkEntry> chunk = take_chunk()) return chunk;
      if (!has_node()) return std::nullopt;
      const WalkEntry node = take_node();
      open(node, source_.node(node.at));
    }
  }

  const WalkCounters& counters() const { return counters_; }
  const WalkQueue& node_queue() const { return nodes_; }
  const WalkQueue& chunk_queue() const { return chunks_; }
  // Heap operations of both queues.
  std::uint64_t queue_operations() const {
    return nodes_.work().operations() + chunks_.work().operations();
  }

 private:
  bool has_room_for_another(const WalkQueue& queue) const {
    const std::size_t children = (opening_.size() + 1) * kChunkNodeWidth;
    const bool starves = of_first(nodes_.nearest()) && !has_chunk();
    return queue.room() >= children + (starves ? 0 : queue.capacity() / 4);
  }

  void drop(WalkQueue& queue) {
    while (!queue.empty() && of_first(queue.nearest())) queue.take_nearest();
  }

  // True if an entry comes before all nodes that are not open.
  bool before_unopened(const WalkEntry& entry) const {
    return (nodes_.empty() || walks_before(entry, nodes_.nearest())) &&
           std::all_of(opening_.begin(), opening_.end(),
                       [&](const WalkEntry& node) { return walks_before(entry, node); });
  }

  const WalkEntry* final_chunk() const {
    if (chunks_.empty()) return nullptr;
    const WalkEntry& chunk = chunks_.nearest();
    const bool final =
        of_first(chunk) && before_unopened(chunk) && !(aside_ && walks_before(*aside_, chunk));
    return final ? &chunk : nullptr;
  }

  bool aside_is_next() const {
    return aside_ && before_unopened(*aside_) &&
           (chunks_.empty() || walks_before(*aside_, chunks_.nearest()));
  }

  void expand(const WalkEntry& parent, const ChunkNode& node) {
    ++counters_.nodes;
    const Group& group = groups_[parent.walk % kWalks];
    const GroupFrustum frustum(*group.view, group.pixels);
    std::uint32_t slot = node.first_slot, inner = node.first_node;
    for (int c = 0; c < node.children; ++c) {
      const std::uint16_t count = node.count[c];
      const std::uint32_t at = count > 0 ? slot : inner;
      (count > 0 ? slot : inner) += count > 0 ? count : 1;
      ++counters_.tests;
      const ChunkTest test = frustum.test(child_bound(node, c));
      // A child's own box may be quantised to begin a little before its parent's.
      if (test.touches) {
        push({std::max(test.nearest, parent.nearest), at, count, parent.walk, test.reach});
      }
    }
  }

  void push(const WalkEntry& entry) {
    WalkQueue& queue = entry.count > 0 ? chunks_ : nodes_;
    if (queue.room() > 0) {
      queue.push(entry);
    } else if (walks_before(entry, queue.farthest())) {
      put_aside(queue.take_farthest());
      queue.push(entry);
    } else {
      put_aside(entry);
    }
  }

  void put_aside(const WalkEntry& entry) {
    if (!aside_ || walks_before(entry, *aside_)) aside_ = entry;
    source_.put_aside(entry);
    ++counters_.put_aside;
  }

  // All of it: what does not fit goes aside again.
  void bring_back() {
    aside_.reset();
    source_.take_back([&](const WalkEntry& entry) {
      // Some may be of a walk that has ended.
      if (!has_ended(entry)) push(entry);
    });
  }

  struct Group {
    const View<float>* view;
    PixelRect pixels;
  };

  Source& source_;
  std::array<Group, kWalks> groups_{};  // by the walk's number modulo kWalks
  std::uint16_t first_ = 0;             // number of the first walk that has not ended
  std::uint32_t begun_ = 0;
  WalkQueue nodes_, chunks_;
  std::vector<WalkEntry> opening_;  // nodes taken and not open yet
  std::optional<WalkEntry> aside_;  // the nearest of those put aside
  WalkCounters counters_;
};

// A chunk tree as the source of a walk (chunk_walk.h) that takes no time and reads no DRAM.
struct TreeInMemory {
  const ChunkTree& tree;
  std::vector<WalkEntry> aside;

  const ChunkNode& node(std::uint32_t index) const { return tree.nodes[index]; }
  void put_aside(const WalkEntry& entry) { aside.push_back(entry); }
  template <class To>
  void take_back(const To& to) {
    for (const WalkEntry& entry : std::exchange(aside, {})) to(entry);
  }
  void forget_aside() { aside.clear(); }
};

}  // namespace sgs
