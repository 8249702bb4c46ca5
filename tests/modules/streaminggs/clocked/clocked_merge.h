// The merge unit register by register: a key at hand, the heap's root with its pace, the spilled
// runs beside it, and a register ahead of the FIFOs of released keys. That a heap keeps that pace
// is shown by one that is stepped itself (tests/modules/streaminggs/stepped_heap.h) and by one in
// Verilog (tests/modules/streaminggs/rtl).
#pragma once

#include <cstdint>
#include <iterator>
#include <optional>
#include <set>
#include <vector>

#include "tests/modules/clocked/clocked_fifo.h"
#include "tests/modules/streaminggs/clocked/clocked_spill.h"

namespace sgs::test {

struct MergeItem {
  std::uint64_t key = 0;  // in final order; of a mark what it is told by
  std::uint32_t group = 0;
  bool is_mark = false, ends_group = false;
  std::uint64_t bound = 0;  // of a mark: keys below it are final
};

// Keys in order. What an operation leaves is seen in the next cycle.
class ClockedHeap {
 public:
  std::size_t size() const { return keys_.size(); }
  std::uint64_t nearest() const { return *keys_.begin(); }
  void insert(std::uint64_t key) { keys_.insert(key); }
  std::uint64_t take_nearest() { return keys_.extract(keys_.begin()).value(); }
  std::uint64_t take_farthest() { return keys_.extract(std::prev(keys_.end())).value(); }
  void clear() { keys_.clear(); }
  void step() {}

 private:
  std::multiset<std::uint64_t> keys_;
};

template <class Heap>
class ClockedMerge {
 public:
  ClockedMerge(Heap& heap, std::uint32_t cycles_per_operation, std::size_t entries,
               const SpillHardware& spill)
      : heap_(heap), pace_(cycles_per_operation), entries_(entries), spill_(spill) {}

  // finished: of a group, whether the news has come; of one that spills it never does.
  template <class Finished>
  void step(std::vector<ClockedFifo<MergeItem>>& in, std::vector<ClockedFifo<MergeItem>>& out,
            const Finished& finished) {
    if (sent_ && out[sequence_ % out.size()].has_room()) {
      out[sequence_++ % out.size()].put(*sent_);
      sent_.reset();
      if (sent_of_run_) spill_.take_nearest();
      sent_of_run_ = false;
    }
    spill_.step_port();
    if (spill_.at_work()) step_spill();
    if (!spill_.at_work() && spill_.ready()) {
      if (!sent_ && releasing_) release(finished(mark_.group));
      if (!sent_ && !releasing_) take(in[visit_ % in.size()], finished);
    }
    heap_busy_ -= heap_busy_ > 0 ? 1 : 0;
    heap_.step();
  }

 private:
  bool begin_operation() {
    if (heap_busy_ > 0) return false;
    heap_busy_ = pace_;
    return true;
  }

  template <class Finished>
  void take(ClockedFifo<MergeItem>& in, const Finished& finished) {
    const bool is_next = !at_hand_ && in.can_take();
    if (is_next) at_hand_ = in.take();
    if (!at_hand_) return;
    if (is_next && !at_hand_->is_mark && finished(at_hand_->group)) {
      at_hand_.reset();
    } else if (at_hand_->is_mark) {
      mark_ = *at_hand_;
      at_hand_.reset();
      releasing_ = true;  // from the next cycle on
      ++visit_;
    } else if (heap_.size() == entries_) {
      spill_.begin(heap_.size());
      step_spill();
    } else if (begin_operation()) {
      heap_.insert(at_hand_->key);
      at_hand_.reset();
    }
  }

  void step_spill() {
    spill_.step([this]() -> std::optional<std::uint64_t> {
      if (!begin_operation()) return {};
      return heap_.take_farthest();
    });
  }

  // What is final, then the mark of a group. Of a finished one no key begins to leave.
  void release(bool finished) {
    if (finished && !leaves_) heap_.clear();
    const std::optional<std::uint64_t> spilled = spill_.nearest();
    if (spilled && (heap_.size() == 0 || *spilled < heap_.nearest()) && *spilled < mark_.bound) {
      sent_ = MergeItem{*spilled};
      sent_of_run_ = true;
      return;
    }
    if (heap_.size() > 0 && heap_.nearest() < mark_.bound) {
      leaves_ = !begin_operation();
      if (leaves_) return;
      sent_ = MergeItem{heap_.take_nearest()};
      return;
    }
    releasing_ = false;
    if (!mark_.ends_group) return;
    spill_.end_group();
    sent_ = mark_;
  }

  Heap& heap_;
  const std::uint32_t pace_;
  const std::size_t entries_;
  ClockedSpill spill_;
  std::uint32_t heap_busy_ = 0;  // cycles until it begins another operation
  std::optional<MergeItem> at_hand_, sent_;
  MergeItem mark_;
  bool releasing_ = false;
  bool leaves_ = false;       // the root, at the heap's pace
  bool sent_of_run_ = false;  // it stays in its block until it has gone
  std::uint64_t visit_ = 0, sequence_ = 0;
};

}  // namespace sgs::test
