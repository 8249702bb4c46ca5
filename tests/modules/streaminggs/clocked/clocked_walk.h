// VSU of exact order register by register: the control of the walk, busy while a queue's heap is;
// nodes on their way from memory; the lanes of the chunk test, a child in each of their turns, and
// the pipeline behind them; the FIFO of final visits with its credits, and what hands them out.
// The numbers of a group are made in the registers of a walk that has ended.
// Which node and chunk comes next is the walk's own (algorithm/order/chunk_walk.h).
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "algorithm/order/chunk_walk.h"
#include "tests/modules/clocked/clocked_chunk_tests.h"
#include "tests/modules/clocked/clocked_fifo.h"
#include "tests/modules/clocked/clocked_group_numbers.h"
#include "tests/modules/clocked/clocked_port.h"
#include "tests/modules/clocked/surroundings.h"

namespace sgs::test {

struct WalkHardware {
  std::uint32_t upper_nodes = 24, nodes_in_flight = 2, nodes_in_test = 8;
  ChunkTestHardware tests;
  std::uint32_t operation_cycles = 3;  // of a queue
  std::uint32_t queue_entries = 512, node_queue_entries = 256;
  GroupNumbersHardware numbers = {};
  PortHardware port = {};
};

class ClockedWalk {
 public:
  static constexpr std::uint64_t kEndOfGroup = std::numeric_limits<std::uint64_t>::max();

  // nodes: of the tree, at their places in memory; they outlive it as view and groups do.
  ClockedWalk(const WalkHardware& hardware, const View<float>& view,
              const std::vector<ChunkNode>& nodes, const RecordArray& places,
              const std::vector<PixelRect>& groups, const Finishing& finishing)
      : hw_(hardware),
        port_(hardware.port),
        nodes_(nodes),
        places_(places),
        groups_(groups),
        finishing_(finishing),
        numbers_(hardware.numbers),
        tests_(hardware.tests, nodes),
        view_(view),
        walk_(aside_, {hw_.node_queue_entries, hw_.queue_entries}) {
    const std::uint64_t upper = std::min<std::uint64_t>(hw_.upper_nodes, nodes.size());
    upper_ = {places.base, upper * places.record_bytes};
    for (std::size_t group = 0; group < groups.size(); ++group) numbers_.ask();
  }

  // visits: one FIFO a HFU, taken in turn.
  void step(std::vector<ClockedFifo<std::uint64_t>>& visits) {
    port_.begin_cycle();
    numbers_.step([&](std::uint32_t group) { return group < group_ + 2; });
    hand_out(visits);
    room_ += credits_;
    credits_ = std::exchange(new_credits_, 0);
    if (busy_ > 0) --busy_;
    if (busy_ == 0 && port_.read(upper_) && port_.answered(upper_) && finish_step()) begin_step();
    tests_.step(now_);
    for (InFlight& node : in_flight_) node.came = port_.answered(node.read);
    ready_.step();
    ++now_;
  }
  // Entries that did not fit the queues, which this machine cannot put aside.
  std::uint64_t put_aside() const { return walk_.counters().put_aside; }

 private:
  struct Aside {
    std::vector<WalkEntry> entries;
    void put_aside(const WalkEntry& entry) { entries.push_back(entry); }
    template <class To>
    void take_back(const To& to) {
      for (const WalkEntry& entry : std::exchange(entries, {})) to(entry);
    }
    void forget_aside() { entries.clear(); }
  };
  struct InFlight {
    WalkEntry entry;
    ClockedTransfer read;
    bool came = false;  // by the last edge
  };
  struct Visit {
    std::uint64_t what;
    std::uint32_t group;
  };

  // What the operation that ends now gives on. False: it waits for the port.
  bool finish_step() {
    if (to_test_) {
      tests_.put(*to_test_);
      to_test_.reset();
    }
    if (to_read_) {
      if (!port_.read(to_read_->read)) return false;
      in_flight_.push_back(*to_read_);
      to_read_.reset();
    }
    return true;
  }

  // The queues' operations since the last step, or a cycle of another kind beside them.
  void take_time(std::uint64_t cycles) {
    const std::uint64_t operations = walk_.queue_operations();
    busy_ = std::max((operations - operations_) * hw_.operation_cycles, cycles);
    operations_ = operations;
  }

  // Until one takes time: what can be done, the longest way first.
  void begin_step() {
    while (busy_ == 0 && group_ < groups_.size()) {
      if (!(begin_group() || read_node() || give_chunk() || enter_children() || begin_test()))
        return;
    }
  }
  // Of the group behind the first nothing is finished.
  bool hidden(const WalkEntry& entry) const {
    return walk_.of_first(entry) && finishing_.all_seen(group_, groups_[group_], entry.reach, now_);
  }
  bool begin_group() {
    if (next_group_ == groups_.size()) return false;
    if (walk_.begun() > 0 && !walk_.has_read_ahead()) return false;
    if (!numbers_.stand(static_cast<std::uint32_t>(next_group_))) return false;
    walk_.begin(view_, groups_[next_group_++], nodes_.empty());
    take_time(1);
    return true;
  }
  bool read_node() {
    if (!walk_.has_node()) return false;
    if (!walk_.has_room_for_another() && !walk_.needs_node()) return false;
    const bool on_chip = walk_.next_node().at < hw_.upper_nodes;
    if (on_chip ? tests_.used() == hw_.nodes_in_test : in_flight_.size() == hw_.nodes_in_flight) {
      return false;
    }
    const WalkEntry entry = walk_.take_node();
    if (hidden(entry)) {
      walk_.leave_out(entry);
    } else if (on_chip) {
      to_test_ = entry;
      tests_.take_place();
    } else {
      to_read_ = InFlight{entry, {places_.address(entry.at), places_.record_bytes}};
    }
    take_time(1);
    return true;
  }
  bool give_chunk() {
    if (room_ == 0 || walk_.begun() == 0) return false;
    if (finishing_.seen(group_, now_) && !walk_.exhausted()) {
      end_group();
      return true;
    }
    if (const std::optional<WalkEntry> next = walk_.take_chunk()) {
      if (hidden(*next)) {
        take_time(1);
        return true;
      }
      if (held_) give(held_->at);
      held_ = next;
      take_time(1);
      return true;
    }
    if (!walk_.exhausted()) return false;
    if (held_) {
      give(held_->at);
      held_.reset();
      take_time(1);
    } else {
      end_group();
    }
    return true;
  }
  void end_group() {
    held_.reset();
    walk_.end();
    give(kEndOfGroup);
    ++group_;
    take_time(1);
  }
  bool enter_children() {
    if (!tests_.can_take()) return false;
    const WalkEntry entry = tests_.take();
    walk_.open(entry, nodes_[entry.at]);
    take_time(1);
    return true;
  }
  bool begin_test() {
    if (in_flight_.empty() || !in_flight_.front().came) return false;
    if (tests_.used() == hw_.nodes_in_test) return false;
    const WalkEntry entry = in_flight_.front().entry;
    in_flight_.pop_front();
    if (!walk_.has_ended(entry)) {
      to_test_ = entry;
      tests_.take_place();
    }
    take_time(1);
    return true;
  }

  void give(std::uint64_t what) {
    ready_.put({what, group_});
    --room_;
  }

  // Of a finished group a visit is dropped in its cycle.
  void hand_out(std::vector<ClockedFifo<std::uint64_t>>& visits) {
    if (out_ && visits[visit_ % visits.size()].has_room()) {
      visits[visit_++ % visits.size()].put(*out_);
      out_.reset();
    }
    if (out_ || !ready_.can_take()) return;
    const Visit visit = ready_.take();
    ++new_credits_;
    if (visit.what == kEndOfGroup || !finishing_.seen(visit.group, now_)) out_ = visit.what;
  }

  const WalkHardware hw_;
  ClockedPort port_;
  ClockedTransfer upper_;  // nodes that are kept on chip, which come first
  const std::vector<ChunkNode>& nodes_;
  const RecordArray& places_;
  const std::vector<PixelRect>& groups_;
  const Finishing finishing_;
  ClockedGroupNumbers numbers_;
  ClockedChunkTests<WalkEntry> tests_;
  const View<float>& view_;
  Aside aside_;
  ChunkWalk<Aside> walk_;
  std::uint64_t now_ = 0, busy_ = 0, operations_ = 0, visit_ = 0;
  std::uint32_t group_ = 0;
  std::size_t next_group_ = 0;
  std::optional<WalkEntry> held_, to_test_;
  std::optional<InFlight> to_read_;
  std::deque<InFlight> in_flight_;
  std::uint32_t room_ = 4, credits_ = 0, new_credits_ = 0;
  ClockedFifo<Visit> ready_{4};
  std::optional<std::uint64_t> out_;
};

}  // namespace sgs::test
