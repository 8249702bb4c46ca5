// Nodes of the chunk tree on their way from DRAM, several at a time. They come out in the order in
// which they were asked for.
#pragma once

#include <cstdint>
#include <deque>
#include <systemc>
#include <utility>
#include <vector>

#include "algorithm/memory/scene_layout.h"
#include "algorithm/voxel/chunk_tree.h"
#include "tlm/memory_access.h"

namespace sgs {

// Two threads of one unit: one asks and takes, the other waits for the memory. A node can be taken
// the cycle after it has come, so that it does not matter which of them the kernel runs first.
// Entry: what the unit knows of a node, whose number it calls `at`.
template <class Entry>
class NodeBuffer {
 public:
  NodeBuffer(std::uint32_t slots, const RecordArray& table) : table_(table), nodes_(slots) {}

  bool full() const { return used_ == nodes_.size(); }
  std::size_t used() const { return used_; }

  // Only where it is not full.
  void ask(const Entry& entry, MemoryPort& port, Activity& activity) {
    Node& node = nodes_[(oldest_ + used_) % nodes_.size()];
    ++used_;
    node.entry = entry;
    const MemoryPort::Ticket ticket = start_read(port, activity, table_.address(entry.at),
                                                 &node.record, sizeof node.record, table_.region);
    asked_.push_back(ticket);
    asked_for_.notify(sc_core::SC_ZERO_TIME);
  }

  // The oldest node is there.
  bool can_take() const {
    return !arrived_.empty() && arrived_.front() <= sc_core::sc_time_stamp();
  }
  // One has come, and can be taken from then on; only where it has.
  bool any_arrived() const { return !arrived_.empty(); }
  const sc_core::sc_time& ready_at() const { return arrived_.front(); }

  // The oldest node and its entry; its slot is free.
  std::pair<Entry, ChunkNode> take() {
    const Node& node = nodes_[oldest_];
    oldest_ = (oldest_ + 1) % nodes_.size();
    --used_;
    arrived_.pop_front();
    return {node.entry, node.record};
  }

  // Body of the thread that waits for the memory; notifies `news` of every node that has come.
  void run_arrivals(MemoryPort& port, const ClockDomain& clock, sc_core::sc_event& news) {
    while (true) {
      while (asked_.empty()) sc_core::wait(asked_for_);
      port.wait_for(asked_.front());
      asked_.pop_front();
      clock.align();
      arrived_.push_back(sc_core::sc_time_stamp() + clock.period());
      news.notify(sc_core::SC_ZERO_TIME);
    }
  }

 private:
  struct Node {
    Entry entry;
    ChunkNode record;
  };

  const RecordArray table_;
  std::vector<Node> nodes_;  // ring
  std::size_t oldest_ = 0, used_ = 0;
  std::deque<MemoryPort::Ticket> asked_;
  std::deque<sc_core::sc_time> arrived_;  // when each can be taken
  sc_core::sc_event asked_for_;
};

}  // namespace sgs
