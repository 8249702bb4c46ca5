// The sorting unit of paper order register by register, of lists that fit its buffer: one splat or
// mark a cycle comes in from the HFUs, round robin, until each has ended the visit; the list passes
// the network and goes out one a cycle. Of a finished group only the mark goes on.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "tests/modules/clocked/clocked_fifo.h"
#include "tests/modules/streaminggs/clocked/clocked_sorting_network.h"

namespace sgs::test {

struct PaperSorterItem {
  std::uint64_t key = 0;  // by which it is sorted
  std::uint32_t group = 0;
  bool is_mark = false;
};

class ClockedPaperSorter {
 public:
  ClockedPaperSorter(const NetworkTurns& turns, bool skip_trivial, std::size_t hfus)
      : skip_trivial_(skip_trivial), network_(turns), ended_(hfus, false) {}

  // finished: of a group, whether the news has come.
  template <class Finished>
  void step(std::vector<ClockedFifo<PaperSorterItem>>& in, ClockedFifo<PaperSorterItem>& out,
            const Finished& finished) {
    if (sent_ && out.has_room()) {
      out.put(*sent_);
      sent_.reset();
    }
    if (state_ == State::kTake) {
      take(in);
      return;
    }
    if (state_ == State::kEnded) begin_sorting(finished(mark_.group));
    if (state_ == State::kSort) {
      sort();
    } else {
      hand_on();
    }
  }

 private:
  enum class State { kTake, kEnded, kSort, kHandOn };

  void take(std::vector<ClockedFifo<PaperSorterItem>>& in) {
    if (sent_) return;  // the mark goes first
    for (std::size_t k = 1; k <= in.size(); ++k) {
      const std::size_t at = (last_ + k) % in.size();
      if (ended_[at] || !in[at].can_take()) continue;
      last_ = at;
      const PaperSorterItem item = in[at].take();
      if (!item.is_mark) {
        list_.push_back(item.key);
        return;
      }
      mark_ = item;
      ended_[at] = true;
      if (std::find(ended_.begin(), ended_.end(), false) == ended_.end()) state_ = State::kEnded;
      return;
    }
  }

  // In the cycle behind the last mark.
  void begin_sorting(bool finished) {
    ended_.assign(ended_.size(), false);
    if (finished) list_.clear();
    const bool in_order = list_.empty() || (list_.size() == 1 && skip_trivial_);
    state_ = in_order ? State::kHandOn : State::kSort;
    if (!in_order) network_.begin(list_.size());
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
      sent_ = PaperSorterItem{list_[next_++], mark_.group, false};
      return;
    }
    sent_ = mark_;
    list_.clear();
    next_ = 0;
    state_ = State::kTake;
  }

  const bool skip_trivial_;
  State state_ = State::kTake;
  ClockedSortingNetwork network_;
  std::vector<bool> ended_;  // [HFU] its mark of this visit has come
  std::size_t last_ = 0;     // HFU of which the last one came
  std::vector<std::uint64_t> list_;
  PaperSorterItem mark_;
  std::optional<PaperSorterItem> sent_;  // the register ahead of the FIFO
  std::size_t next_ = 0;                 // of the list, to go out
};

}  // namespace sgs::test
