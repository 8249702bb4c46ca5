// The bitonic sorting unit cycle by cycle: a register behind each stage, two memories of 16 banks
// with a read and a write port each, and a control that knows of the entries only what it has read.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

namespace sgs::test {

class SteppedBitonic {
 public:
  // Key above, place below: no two are equal.
  using Entry = std::uint64_t;

  explicit SteppedBitonic(std::vector<Entry> list) : list_(std::move(list)) {
    for (auto& memory : memory_) memory.assign(list_.size(), kNone);
  }

  // Entries in order.
  std::vector<Entry> run() {
    for (std::size_t at = 0; at < list_.size(); at += kWidth) step([&] { return read_block(at); });
    drain();
    std::size_t from = 0;
    for (std::size_t run = kWidth; run < list_.size(); run *= 2, from = 1 - from) {
      merge_level(run, from);
    }
    return memory_[from];
  }

  std::uint64_t cycles() const { return cycles_; }
  std::uint64_t compare_exchanges() const { return compare_exchanges_; }
  std::uint64_t merged() const { return merged_; }
  // Of one port of a bank within a cycle.
  std::uint32_t most_at_a_port() const { return most_at_a_port_; }

 private:
  static constexpr std::size_t kWidth = 16, kHalf = 8, kStages = 10, kMergeStages = 4;
  static constexpr Entry kNone = std::numeric_limits<Entry>::max();  // behind the end of a run
  using Half = std::array<Entry, kHalf>;

  // Two runs that become one.
  struct Pair {
    std::size_t at[2], end[2];  // where the runs go on and end
    std::size_t to;             // where what comes next is written
    Entry tail[2] = {0, 0};     // the last entry taken of each run
    bool begun = false, copies = false;
    bool empty() const { return at[0] == end[0] && at[1] == end[1]; }
  };
  // What goes through the stages together.
  struct Row {
    std::array<Entry, kWidth> entries{};
    std::size_t slot = 0, to = 0, list = 0;
    bool sorts = false, first = false, last = false, copies = false;
  };

  Row read_block(std::size_t at) {
    Row row;
    row.sorts = true;
    row.to = at;
    row.entries.fill(kNone);
    std::array<std::uint32_t, kWidth> at_port{};
    for (std::size_t i = 0; i < kWidth && at + i < list_.size(); ++i) {
      row.entries[i] = list_[at + i];
      count(at_port, at + i);
    }
    return row;
  }

  void merge_level(std::size_t run, std::size_t from) {
    std::vector<Pair> pairs;
    for (std::size_t first = 0; first < list_.size(); first += 2 * run) {
      const std::size_t middle = std::min(first + run, list_.size());
      const std::size_t end = std::min(middle + run, list_.size());
      pairs.push_back(Pair{{first, middle}, {middle, end}, first});
      pairs.back().copies = middle == end;
    }
    std::array<std::optional<Pair>, kMergeStages> slots;
    std::size_t next = 0;
    const auto more = [&] {
      return next < pairs.size() ||
             std::any_of(slots.begin(), slots.end(), [](const auto& slot) { return slot; });
    };
    for (std::size_t turn = 0; more(); ++turn) {
      const std::size_t s = turn % kMergeStages;
      if (!slots[s] && next < pairs.size()) slots[s] = pairs[next++];
      step([&]() -> std::optional<Row> {
        if (!slots[s]) return {};
        const Row row = read_turn(*slots[s], s, from);
        if (row.last) slots[s].reset();
        return row;
      });
    }
    drain();
  }

  // The next 8 entries of the run whose last taken one is nearer.
  Row read_turn(Pair& pair, std::size_t slot, std::size_t from) {
    const bool of_second =
        pair.at[0] == pair.end[0] || (pair.at[1] != pair.end[1] && pair.tail[1] < pair.tail[0]);
    const std::size_t run = of_second ? 1 : 0;
    Row row;
    row.slot = slot;
    row.list = 1 - from;
    row.first = !pair.begun;
    row.copies = pair.copies;
    row.to = pair.to;
    row.entries.fill(kNone);
    std::array<std::uint32_t, kWidth> at_port{};
    for (std::size_t i = 0; i < kHalf; ++i) {
      if (pair.at[run] == pair.end[run]) continue;
      count(at_port, pair.at[run]);
      row.entries[kHalf + i] = memory_[from][pair.at[run]++];
      ++merged_;
    }
    pair.tail[run] = row.entries[kWidth - 1];
    pair.begun = true;
    row.last = pair.empty();
    if (!row.first || pair.copies) pair.to += kHalf;
    return row;
  }

  // A cycle: every register takes what the one before it held.
  template <class Read>
  void step(const Read& read) {
    ++cycles_;
    const std::optional<Row> out = behind_[kStages - 1];
    if (out) write(*out);
    for (std::size_t stage = kStages - 1; stage > 0; --stage) {
      if (stage == kStages - kMergeStages && read_ && !read_->sorts) {
        if (behind_[stage - 1]) throw std::logic_error("a block where a turn comes in");
        behind_[stage] = exchanged(joined(*read_, out), stage);
      } else {
        behind_[stage] = exchanged(behind_[stage - 1], stage);
      }
    }
    behind_[0] = read_ && read_->sorts ? exchanged(read_, 0) : std::nullopt;
    read_ = read();
  }
  void drain() {
    const auto holds = [](const auto& row) { return row.has_value(); };
    while (read_ || std::any_of(behind_.begin(), behind_.end(), holds)) {
      step([] { return std::optional<Row>(); });
    }
  }

  // With the farther half of what the turn before gave, which leaves the network in this cycle.
  static Row joined(Row row, const std::optional<Row>& out) {
    if (row.first || row.copies) return row;
    if (!out || out->slot != row.slot) throw std::logic_error("what was kept is not there");
    std::copy(out->entries.begin() + kHalf, out->entries.end(), row.entries.begin());
    std::reverse(row.entries.begin() + kHalf, row.entries.end());
    return row;
  }

  std::optional<Row> exchanged(std::optional<Row> row, std::size_t stage) {
    if (!row || (!row->sorts && (row->first || row->copies))) return row;
    static constexpr std::size_t kDistance[kStages] = {1, 2, 1, 4, 2, 1, 8, 4, 2, 1};
    static constexpr std::size_t kBlock[kStages] = {2, 4, 4, 8, 8, 8, 16, 16, 16, 16};
    for (std::size_t i = 0; i < kWidth; ++i) {
      const std::size_t other = i ^ kDistance[stage];
      if (other < i) continue;
      ++compare_exchanges_;
      const bool rising = (i & kBlock[stage]) == 0;
      if ((row->entries[i] > row->entries[other]) == rising) {
        std::swap(row->entries[i], row->entries[other]);
      }
    }
    return row;
  }

  void write(const Row& row) {
    const bool holds_only = !row.sorts && row.first && !row.copies;
    if (holds_only) return;
    const bool alone = row.copies;  // 8, in the farther half
    const std::size_t first = alone ? kHalf : 0;
    const std::size_t end = row.sorts || alone || row.last ? kWidth : kHalf;
    std::array<std::uint32_t, kWidth> at_port{};
    for (std::size_t i = first; i < end; ++i) {
      const std::size_t at = row.to + i - first;
      if (at >= list_.size()) break;
      count(at_port, at);
      memory_[row.list][at] = row.entries[i];
    }
  }

  void count(std::array<std::uint32_t, kWidth>& at_port, std::size_t at) {
    most_at_a_port_ = std::max(most_at_a_port_, ++at_port[at % kWidth]);
  }

  const std::vector<Entry> list_;
  std::array<std::vector<Entry>, 2> memory_;
  std::optional<Row> read_;
  std::array<std::optional<Row>, kStages> behind_;  // each stage
  std::uint64_t cycles_ = 0, compare_exchanges_ = 0, merged_ = 0;
  std::uint32_t most_at_a_port_ = 0;
};

}  // namespace sgs::test
