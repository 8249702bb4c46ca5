// The lists of a tile lister register by register: a listed tile at hand, its record and its entry
// on their way to what is combined, the writes that follow from it one a cycle, and at the end of a
// pass the scan of the lines; then tiles for the cores that ask.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "tests/modules/clocked/clocked_port.h"
#include "tests/modules/gscore/clocked/clocked_tile_tests.h"

namespace sgs::test {

struct ListerHardware {
  std::uint32_t lines = 64, records_at_once = 8;
  std::uint32_t first_entries = 4, line_entries = 5, block_lines = 16;
  std::uint32_t record_bytes = 32, line_bytes = 32;  // a line is a word of the port
  PortHardware port = {};
};

class ClockedLister {
 public:
  ClockedLister(const ListerHardware& hardware, std::uint32_t most_tiles, std::uint32_t all_tiles)
      : hw_(hardware),
        most_(most_tiles),
        all_(all_tiles),
        lines_(hardware.lines),
        port_(hardware.port) {}

  // Whether a pass begins in this cycle, whose tiles are [first(), end()).
  bool begins() const { return begins_; }
  std::uint32_t first() const { return first_; }
  std::uint32_t end() const { return end_; }
  bool wrote() const { return wrote_; }  // a transaction, in this cycle

  // Cores: what they ask, what they are given (a tile with its entries, or the end of a pass), and
  // that they have done with it.
  template <class WhatOf>
  void step(ClockedFifo<ClockedTile>& listed, std::vector<ClockedFifo<std::uint64_t>>& requests,
            std::vector<ClockedFifo<std::uint64_t>>& jobs,
            std::vector<ClockedFifo<std::uint64_t>>& done, const WhatOf& what_of) {
    port_.begin_cycle();
    begins_ = wrote_ = false;
    if (wait_ > 0 && --wait_ > 0) return;
    while (advance(listed, requests, jobs, done, what_of)) {
    }
  }

 private:
  enum class Do { kBegin, kTake, kWrite, kScan, kDrain, kAnswer, kGive, kDone, kOver };
  // A line is read in the cycle in which it leaves: the memory's only port has no entry then.
  struct Write {
    std::uint64_t bytes;
    bool of_line;
  };
  struct Line {
    std::uint32_t tile = 0;  // 0: none
    bool holds_new = false;
  };

  template <class WhatOf>
  bool advance(ClockedFifo<ClockedTile>& listed, std::vector<ClockedFifo<std::uint64_t>>& requests,
               std::vector<ClockedFifo<std::uint64_t>>& jobs,
               std::vector<ClockedFifo<std::uint64_t>>& done, const WhatOf& what_of) {
    switch (do_) {
      case Do::kBegin:
        return begin();
      case Do::kTake:
        if (!listed.can_take()) return false;
        scanned_ = 0;
        tile_ = listed.take();
        do_ = tile_.ends_pass ? Do::kScan : Do::kWrite;
        if (tile_.ends_pass) return true;
        enter();
        return waits();
      case Do::kWrite:
        while (!writes_.empty()) {
          const Write next = writes_.front();
          if (!write(next.bytes)) return false;
          writes_.pop_front();
          if (next.of_line) return waits();
        }
        do_ = Do::kTake;
        return true;
      case Do::kScan:
        return scan();
      case Do::kDrain:
        if (records_ > 0 && !write(records_ * hw_.record_bytes)) return false;
        records_ = 0;
        if (!port_.idle()) return false;
        do_ = Do::kAnswer;
        next_ = first_;
        return true;
      case Do::kAnswer:
        return answer(requests);
      case Do::kGive:
        if (!jobs[core_].has_room()) return false;
        jobs[core_].put(next_ < end_ ? what_of(next_, entries_[next_ - first_]) : what_of(all_, 0));
        ++next_;
        do_ = next_ == end_ + requests.size() ? Do::kDone : Do::kAnswer;
        return true;
      case Do::kDone:
        for (ClockedFifo<std::uint64_t>& core : done) {
          if (!core.can_take()) return false;
        }
        for (ClockedFifo<std::uint64_t>& core : done) core.take();
        first_ = end_;
        do_ = first_ == all_ ? Do::kOver : Do::kBegin;
        return first_ < all_;
      case Do::kOver:
        return false;
    }
    return false;
  }
  bool waits(std::uint32_t cycles = 1) {
    wait_ = cycles;
    return false;
  }
  // All in one transaction.
  bool write(std::uint64_t bytes) {
    ClockedTransfer what{0, bytes};
    if (!port_.write(what)) return false;
    wrote_ = true;
    return true;
  }

  // A row of the table a cycle is cleared.
  bool begin() {
    end_ = std::min(first_ + most_, all_);
    begins_ = true;
    entries_.assign(end_ - first_, 0);
    for (Line& line : lines_) line = {};
    told_.clear();
    do_ = Do::kTake;
    return waits(end_ - first_);
  }

  // What is written because of it: records, the line of another tile, its own line.
  void enter() {
    if (tile_.first && ++records_ == hw_.records_at_once) {
      writes_.push_back({records_ * hw_.record_bytes, false});
      records_ = 0;
    }
    const std::uint32_t at = tile_.tile - first_;
    Line& line = lines_[at % hw_.lines];
    if (line.tile != at + 1) {
      if (line.holds_new) writes_.push_back({hw_.line_bytes, true});
      line = {at + 1, false};
    }
    const std::uint32_t in_block = ++entries_[at] % block_entries();
    const bool full = in_block == 0 || (in_block >= hw_.first_entries &&
                                        (in_block - hw_.first_entries) % hw_.line_entries == 0);
    if (full) writes_.push_back({hw_.line_bytes, true});
    line.holds_new = !full;
  }
  std::uint32_t block_entries() const {
    return hw_.first_entries + (hw_.block_lines - 1) * hw_.line_entries;
  }

  // A line a cycle is looked at; what is new in it leaves in that cycle.
  bool scan() {
    if (scanned_ == hw_.lines) {
      do_ = Do::kDrain;
      return true;
    }
    Line& line = lines_[scanned_];
    if (line.holds_new && !write(hw_.line_bytes)) return false;
    ++scanned_;
    return waits();
  }

  // Of those that ask the next in turn; at the end of the pass each once.
  bool answer(std::vector<ClockedFifo<std::uint64_t>>& requests) {
    if (told_.empty()) told_.assign(requests.size(), false);
    for (std::size_t k = 1; k <= requests.size(); ++k) {
      const std::size_t core = (core_ + k) % requests.size();
      if (!requests[core].can_take() || told_[core]) continue;
      requests[core].take();
      core_ = core;
      told_[core] = next_ >= end_;
      do_ = Do::kGive;
      return waits();
    }
    return false;
  }

  const ListerHardware hw_;
  const std::uint32_t most_, all_;
  Do do_ = Do::kBegin;
  std::uint32_t wait_ = 0, first_ = 0, end_ = 0, next_ = 0;
  bool begins_ = false, wrote_ = false;
  std::vector<std::uint32_t> entries_;  // [tile of the pass]
  std::vector<Line> lines_;
  ClockedTile tile_;
  std::deque<Write> writes_;
  std::uint32_t records_ = 0, scanned_ = 0;
  std::size_t core_ = 0;
  std::vector<bool> told_;  // that the pass is over
  ClockedPort port_;
};

}  // namespace sgs::test
