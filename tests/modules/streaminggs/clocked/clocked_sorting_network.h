// The sorting network of both orders register by register: a list passes it in blocks of 16, then
// its runs are merged, 8 entries at a time, level by level. It goes round by turns; other lists
// that share it have a turn each before every one of this list.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace sgs::test {

struct NetworkTurns {
  std::uint32_t block_cycles = 1, merge_cycles = 2;  // of a turn
  std::uint32_t lists = 1;                           // that have turns, this one the last
};

class ClockedSortingNetwork {
 public:
  explicit ClockedSortingNetwork(const NetworkTurns& turns = {}) : turns_(turns) {}

  // A list at hand, at least one entry.
  void begin(std::size_t entries) {
    entries_ = entries;
    blocks_ = runs_ = (entries + kWidth - 1) / kWidth;
    run_entries_ = kWidth;
    others_first(turns_.block_cycles);
  }
  bool done() const { return runs_ == 0; }

  // A cycle: in a turn of the list a block or a merge goes in; what is written is done.
  void step() {
    if (wait_ == 0) take_turn();
    --wait_;
    for (Pair& pair : pairs_) pair.busy -= pair.busy > 0 ? 1 : 0;
    for (std::uint32_t& left : rows_) --left;
    rows_.erase(std::remove(rows_.begin(), rows_.end(), 0U), rows_.end());
    if (blocks_ > 0 || merges_ > 0 || !rows_.empty()) return;
    if (runs_ == 1) {
      runs_ = 0;
    } else {
      begin_level();
    }
  }

 private:
  static constexpr std::size_t kWidth = 16, kHalf = 8;
  static constexpr std::uint32_t kStages = 10, kMergeStages = 4;
  // Two runs that become one: merges that are still to begin, cycles until the farther half of the
  // last one has come back.
  struct Pair {
    std::size_t merges;
    bool alone;  // a run that goes into the other list as it is
    std::uint32_t busy = 0;
  };

  void others_first(std::uint32_t cycles) {
    turn_ = turns_.lists * cycles;
    wait_ = turn_ - cycles;
  }
  void take_turn() {
    wait_ = turn_;
    if (blocks_ > 0) {
      --blocks_;
      rows_.push_back(1 + kStages + 1);  // read, through the stages, written
      return;
    }
    for (std::size_t p = 0; p < pairs_.size(); ++p) {
      const std::size_t at = (first_ + p) % pairs_.size();
      if (pairs_[at].merges == 0 || pairs_[at].busy > 0) continue;
      --pairs_[at].merges;
      --merges_;
      pairs_[at].busy = pairs_[at].alone ? 0 : kMergeStages;
      rows_.push_back(1 + kMergeStages + 1);
      first_ = at + 1;
      return;
    }
  }
  void begin_level() {
    pairs_.clear();
    for (std::size_t from = 0; from < entries_; from += 2 * run_entries_) {
      const std::size_t of_pair = std::min(2 * run_entries_, entries_ - from);
      pairs_.push_back({(of_pair + kHalf - 1) / kHalf, of_pair <= run_entries_});
      merges_ += pairs_.back().merges;
    }
    first_ = 0;
    runs_ = pairs_.size();
    run_entries_ *= 2;
    others_first(turns_.merge_cycles);
  }

  const NetworkTurns turns_;
  std::size_t entries_ = 0, run_entries_ = 0, runs_ = 0;
  std::size_t blocks_ = 0, merges_ = 0;  // that are still to begin, of this level
  std::vector<Pair> pairs_;
  std::size_t first_ = 0;              // pair that is asked first
  std::vector<std::uint32_t> rows_;    // in the network: cycles until each is written
  std::uint32_t turn_ = 1, wait_ = 0;  // cycles between turns, until the next
};

}  // namespace sgs::test
