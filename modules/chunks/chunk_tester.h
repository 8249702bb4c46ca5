// The chunk test as a pipeline: several nodes are in it at a time. A node's children pass the lanes
// one behind the other, each in the lanes' next turn; when the last has left the pipeline what
// became of them can go into the queues. Nodes come out in the order in which they were put in.
#pragma once

#include <cstdint>
#include <systemc>

#include "algorithm/voxel/chunk_tree.h"
#include "modules/datapath/work_rates.h"
#include "tlm/datapath.h"
#include "tlm/timed_fifo.h"

namespace sgs {

// entry: what the unit knows of the node beside its record.
template <class Entry>
struct NodeInTest {
  Entry entry;
  ChunkNode record;
};

// One thread puts and takes; another is the lanes.
template <class Entry>
class ChunkTester {
 public:
  // slots: nodes in it at a time; depth_cycles: from a child's beginning to its end.
  ChunkTester(const ClockDomain& clock, const Datapath& lanes, std::uint32_t slots,
              std::uint32_t depth_cycles)
      : lanes_(lanes),
        slots_(slots),
        test_("test", clock),
        waiting_("nodes_to_test", clock, slots),
        tested_("nodes_tested", clock, slots,
                cycles_behind_lanes(depth_cycles, lanes.interval_cycles())) {}

  // Cycles from the time when the lanes are free of a node's last child until it has left the
  // pipeline and stands in a register.
  static std::uint32_t cycles_behind_lanes(std::uint32_t depth_cycles,
                                           std::uint64_t interval_cycles) {
    const std::uint64_t end = depth_cycles + std::uint64_t{1};
    return end > interval_cycles ? static_cast<std::uint32_t>(end - interval_cycles) : 1;
  }

  bool full() const { return used_ == slots_; }
  std::uint32_t used() const { return used_; }
  // Only where it is not full.
  void put(const NodeInTest<Entry>& node, Activity& activity) {
    ++used_;
    waiting_.push(node, activity);
  }

  bool can_take() const { return tested_.can_pop(); }
  // One has left the lanes, and can be taken from then on; only where it has.
  bool any_tested() const { return !tested_.empty(); }
  const sc_core::sc_time& ready_at() const { return tested_.ready_at(); }
  NodeInTest<Entry> take(Activity& activity) {
    --used_;
    return tested_.pop(activity);
  }

  // Body of the lanes' thread. take_up(entry): its children are tested next.
  template <class TakeUp>
  void run(const TakeUp& take_up) {
    while (true) {
      const NodeInTest<Entry> node = waiting_.pop(test_);
      take_up(node.entry);
      const std::uint64_t now = test_.clock().now_cycles(), interval = lanes_.interval_cycles();
      test_.work(next_turn(now, interval) - now + node.record.children * interval);
      tests_ += node.record.children;
      ++nodes_;
      tested_.push(node, test_);
    }
  }

  void announce_to(sc_core::sc_event& news) { tested_.announce_to(news); }
  Activity& activity() { return test_; }
  std::uint64_t tests() const { return tests_; }
  std::uint64_t nodes() const { return nodes_; }
  // Places of waiting: for a slot, and for the nodes in the slots.
  const sc_core::sc_object& slots() const { return waiting_; }
  const sc_core::sc_object& pipeline() const { return tested_; }
  const Datapath& lanes() const { return lanes_; }

 private:
  const Datapath lanes_;
  const std::uint32_t slots_;
  Activity test_;
  TimedFifo<NodeInTest<Entry>> waiting_, tested_;
  std::uint32_t used_ = 0;
  std::uint64_t tests_ = 0, nodes_ = 0;  // so far; tests: of children
};

}  // namespace sgs
