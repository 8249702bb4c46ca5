// The sorting unit of exact order register by register: keys come in one a cycle, pass the bitonic
// network a block of 16 behind the other, and where there are several runs these are merged 8
// entries at a time; then they go out one a cycle.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "tests/modules/streaminggs/clocked/clocked_fifo.h"

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
  static constexpr std::size_t kWidth = 16, kHalf = 8;
  static constexpr std::uint32_t kStages = 10, kMergeStages = 4;
  // What goes through the network together: so many cycles until it is written.
  struct Row {
    std::uint32_t left;
    std::size_t pair;
  };
  // Two runs that become one: merges that are still to begin, and whether one is under way.
  struct Pair {
    std::size_t merges;
    bool alone;  // a run that goes into the other list as it is
    std::uint32_t busy = 0;
  };

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
    blocks_ = (list_.size() + kWidth - 1) / kWidth;
    runs_ = blocks_;
    state_ = State::kSort;
    sort();
  }

  // A cycle of the network: a block or a merge goes in, what is written is done.
  void sort() {
    if (blocks_ > 0) {
      --blocks_;
      rows_.push_back({1 + kStages + 1, 0});
    } else if (!pairs_.empty()) {
      begin_merge();
    }
    for (Pair& pair : pairs_) pair.busy -= pair.busy > 0 ? 1 : 0;
    if (network_busy_ > 0) --network_busy_;
    for (Row& row : rows_) --row.left;
    rows_.erase(
        std::remove_if(rows_.begin(), rows_.end(), [](const Row& r) { return r.left == 0; }),
        rows_.end());
    const bool done = blocks_ == 0 && rows_.empty() &&
                      std::all_of(pairs_.begin(), pairs_.end(),
                                  [](const Pair& pair) { return pair.merges == 0; });
    if (!done) return;
    pairs_.clear();
    if (runs_ > 1) {
      next_level();
      return;
    }
    std::sort(list_.begin(), list_.end());
    state_ = State::kHandOn;
  }

  // Of each pair of runs, 8 entries go in where the farther half of the merge before has come back.
  void begin_merge() {
    if (network_busy_ > 0) return;
    for (std::size_t p = 0; p < pairs_.size(); ++p) {
      const std::size_t at = (first_ + p) % pairs_.size();
      if (pairs_[at].merges == 0 || pairs_[at].busy > 0) continue;
      --pairs_[at].merges;
      pairs_[at].busy = pairs_[at].alone ? 0 : kMergeStages;
      network_busy_ = kMergeInterval;
      rows_.push_back({1 + kMergeStages + 1, at});
      first_ = at + 1;
      return;
    }
  }
  void next_level() {
    const std::size_t entries = run_entries_ = run_entries_ == 0 ? kWidth : 2 * run_entries_;
    for (std::size_t from = 0; from < list_.size(); from += 2 * entries) {
      const std::size_t of_pair = std::min(2 * entries, list_.size() - from);
      pairs_.push_back({(of_pair + kHalf - 1) / kHalf, of_pair <= entries});
    }
    runs_ = (runs_ + 1) / 2;
  }

  void hand_on() {
    if (sent_) return;
    if (next_ < list_.size()) {
      sent_ = SorterItem{list_[next_++], false};
      return;
    }
    sent_ = mark_;
    list_.clear();
    next_ = run_entries_ = first_ = 0;
    state_ = State::kTake;
  }

  static constexpr std::uint32_t kMergeInterval = 2;
  State state_ = State::kTake;
  std::vector<std::uint64_t> list_;
  SorterItem mark_;
  std::optional<SorterItem> sent_;
  std::size_t next_ = 0;  // of the list, to go out
  std::size_t blocks_ = 0, runs_ = 0, run_entries_ = 0, first_ = 0;
  std::vector<Pair> pairs_;
  std::vector<Row> rows_;
  std::uint32_t network_busy_ = 0;
};

}  // namespace sgs::test
