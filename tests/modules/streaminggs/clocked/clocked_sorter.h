// The sorting unit of exact order register by register: keys come in one a cycle, pass the network,
// and go out one a cycle.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "tests/modules/clocked/clocked_fifo.h"
#include "tests/modules/streaminggs/clocked/clocked_sorting_network.h"

namespace sgs::test {

struct SorterItem {
  std::uint64_t key = 0;  // by which it is sorted
  bool is_mark = false;
};

class ClockedSorter {
 public:
  void step(ClockedFifo<SorterItem>& in, ClockedFifo<SorterItem>& out) {
    send(out);
    switch (state_) {
      case State::kTake:
        take(in);
        break;
      case State::kSort:
        sort();
        break;
      case State::kHandOn:
        hand_on();
        break;
    }
  }

 private:
  enum class State { kTake, kSort, kHandOn };

  // The register ahead of the FIFO.
  void send(ClockedFifo<SorterItem>& out) {
    if (!sent_ || !out.has_room()) return;
    out.put(*sent_);
    sent_.reset();
  }

  void take(ClockedFifo<SorterItem>& in) {
    if (sent_ || !in.can_take()) return;  // the mark goes first
    const SorterItem item = in.take();
    if (!item.is_mark) {
      list_.push_back(item.key);
      return;
    }
    mark_ = item;
    if (list_.size() < 2) {  // in order already: what goes out first goes in this cycle
      state_ = State::kHandOn;
      hand_on();
      return;
    }
    network_.begin(list_.size());
    state_ = State::kSort;
    sort();
  }

  void sort() {
    network_.step();
    if (!network_.done()) return;
    std::sort(list_.begin(), list_.end());
    state_ = State::kHandOn;
  }

  void hand_on() {
    if (sent_) return;
    if (next_ < list_.size()) {
      sent_ = SorterItem{list_[next_++], false};
      return;
    }
    sent_ = mark_;
    list_.clear();
    next_ = 0;
    state_ = State::kTake;
  }

  State state_ = State::kTake;
  ClockedSortingNetwork network_;
  std::vector<std::uint64_t> list_;
  SorterItem mark_;
  std::optional<SorterItem> sent_;
  std::size_t next_ = 0;  // of the list, to go out
};

}  // namespace sgs::test
