// The chunk test register by register: a child in each of the lanes' turns, and the pipeline behind
// them. Nodes keep their places until they are taken.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "algorithm/voxel/chunk_tree.h"
#include "tests/modules/clocked/clocked_fifo.h"

namespace sgs::test {

struct ChunkTestHardware {
  std::uint32_t test_cycles = 8;  // of a child on the lanes
  std::uint32_t depth_cycles = 198;
};

// Entry: what a unit knows of a node, whose number it calls `at`.
template <class Entry>
class ClockedChunkTests {
 public:
  // nodes: of the tree; they outlive it.
  ClockedChunkTests(const ChunkTestHardware& hardware, const std::vector<ChunkNode>& nodes)
      : hw_(hardware), nodes_(nodes) {}

  std::uint32_t used() const { return used_; }
  // A place is taken ahead of the cycle in which the node comes.
  void take_place() { ++used_; }
  void put(const Entry& entry) { waiting_.put(entry); }

  bool can_take() const { return !tested_.empty() && tested_.front().left == 0; }
  Entry take() {
    const Entry entry = tested_.front().entry;
    tested_.pop_front();
    --used_;
    return entry;
  }

  // A node's last child, out of the pipeline, brings it back.
  void step(std::uint64_t now) {
    test(now);
    for (Tested& node : tested_) node.left -= node.left > 0 ? 1 : 0;
    waiting_.step();
  }

 private:
  struct Tested {
    Entry entry;
    std::uint32_t left;  // cycles until it can be taken
  };

  void test(std::uint64_t now) {
    if (now % hw_.test_cycles != 0) return;
    if (children_ == 0) {
      if (!waiting_.can_take()) return;
      on_lanes_ = waiting_.take();
      children_ = nodes_[on_lanes_.at].children;
    }
    if (--children_ == 0) tested_.push_back({on_lanes_, hw_.depth_cycles + 1});
  }

  const ChunkTestHardware hw_;
  const std::vector<ChunkNode>& nodes_;
  ClockedFifo<Entry> waiting_{1024};  // used_ bounds it
  std::uint32_t used_ = 0, children_ = 0;
  Entry on_lanes_{};
  std::deque<Tested> tested_;
};

}  // namespace sgs::test
