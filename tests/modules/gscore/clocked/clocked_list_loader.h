// The loading side of a tile sorter register by register: one control that asks for a block and
// then hands on the entries of the block before, one a cycle; to a list on chip or, of what is too
// long, through the first QSU into lines of eight subsets that are written to memory and read back.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "tests/modules/gscore/clocked/clocked_list_sorter.h"
#include "tests/modules/gscore/clocked/clocked_subset_lines.h"

namespace sgs::test {

class ClockedListLoader {
 public:
  explicit ClockedListLoader(const SorterHardware& hardware)
      : hw_(hardware), free_lists_(hardware.list_buffers), port_(hardware.port), lines_(hardware) {}

  void free_list() { ++free_lists_; }

  // requests, jobs: a list with its mark, of a tile or (without entries) of the frame.
  template <class Finished>
  void step(ClockedFifo<std::uint64_t>& requests, ClockedFifo<LoadedList>& jobs,
            ClockedFifo<LoadedList>& loaded, const Finished& finished) {
    port_.begin_cycle();
    if (!lines_.leave(port_)) return;
    if (wait_ > 0 && --wait_ > 0) return;
    while (advance(requests, jobs, loaded, finished)) {
    }
  }

 private:
  enum class Do { kRequest, kJob, kNext, kList, kSend, kHead, kRest, kEntries, kLines, kEnd };
  struct Chain {
    SorterList entries;
    std::uint32_t level = 0;
  };
  struct Block {
    std::size_t entries = 0;
    ClockedTransfer head, rest;
    bool followed = false;  // its link
  };
  // One step of the control; true: the next one follows in the same cycle.
  template <class Finished>
  bool advance(ClockedFifo<std::uint64_t>& requests, ClockedFifo<LoadedList>& jobs,
               ClockedFifo<LoadedList>& loaded, const Finished& finished) {
    switch (do_) {
      case Do::kRequest:
        if (frame_ended_ || !requests.has_room()) return false;
        requests.put(0);
        do_ = Do::kJob;
        return true;
      case Do::kJob:
        if (!jobs.can_take()) return false;
        job_ = jobs.take();
        chains_ = {{job_.entries, 0}};
        do_ = Do::kNext;
        return true;
      case Do::kNext:
        return next_chain(finished);
      case Do::kList:
        if (free_lists_ == 0) return false;
        --free_lists_;
        return ask();
      case Do::kSend:
        return send();
      case Do::kHead:
        return follow();
      case Do::kRest:
        if (!port_.answered(blocks_.front().rest)) return false;
        do_ = Do::kEntries;
        if (!splits_ || chosen_) return true;
        pivots_ = sample(chain_.entries, blocks_.front().entries);
        chosen_ = true;
        return waits(kQsuPivots);
      case Do::kEntries:
        return splits_ ? split_entry() : load_entry(loaded);
      case Do::kLines:
        return flush();
      case Do::kEnd:
        if (!loaded.has_room()) return false;
        loaded.put({true, job_.tile, job_.mark, {}});
        frame_ended_ = job_.is_mark;
        do_ = Do::kRequest;
        return true;
    }
    return false;
  }
  bool waits(std::uint32_t cycles) {
    wait_ = cycles;
    return false;
  }

  template <class Finished>
  bool next_chain(const Finished& finished) {
    if (finished(job_.tile)) chains_.clear();
    if (chains_.empty()) {
      do_ = Do::kEnd;
      return waits(1);
    }
    chain_ = std::move(chains_.back());
    chains_.pop_back();
    if (chain_.entries.empty()) return true;
    const auto [least, greatest] = key_range(chain_.entries);
    const bool one_key = chain_.level > 0 && least == greatest;
    splits_ = chain_.entries.size() > hw_.list_entries && !one_key;
    asked_ = read_ = held_ = 0;
    open_ = !splits_;
    chosen_ = chain_.level > 0;
    do_ = splits_ ? Do::kSend : Do::kList;
    if (!splits_) return true;
    lines_.begin();
    prepare();
    if (!chosen_) return waits(1);
    pivots_ = eighths(chain_.entries);
    return waits(kQsuPivots + 1);
  }

  // A block: its address in a register, then its transactions, the first line first.
  bool ask() {
    prepare();
    do_ = Do::kSend;
    return waits(1);
  }
  void prepare() {
    Block block;
    block.entries = std::min(chain_.entries.size() - asked_, hw_.block_entries());
    asked_ += block.entries;
    const std::size_t bytes = hw_.used_bytes(block.entries);
    block.head = {0, std::min<std::size_t>(bytes, hw_.line_bytes)};
    block.rest = {block.head.bytes, bytes - block.head.bytes};
    blocks_.push_back(block);
  }
  bool send() {
    Block& block = blocks_.back();
    if (!port_.read(block.head) || !port_.read(block.rest)) return false;
    do_ = Do::kHead;
    return true;
  }
  // The first line of the block in hand has the number of the next.
  bool follow() {
    Block& block = blocks_.front();
    if (!port_.answered(block.head)) return false;
    if (!block.followed) {
      block.followed = true;
      if (asked_ < chain_.entries.size()) return ask();
    }
    do_ = Do::kRest;
    return true;
  }

  // True: the block in hand is through.
  bool block_done() {
    if (blocks_.front().entries > 0) return false;
    blocks_.pop_front();
    return true;
  }
  bool load_entry(ClockedFifo<LoadedList>& loaded) {
    const bool chain_done = read_ == chain_.entries.size();
    if (held_ == hw_.list_entries || (chain_done && held_ > 0)) {
      if (!loaded.has_room()) return false;
      const auto from = chain_.entries.begin() + static_cast<std::ptrdiff_t>(read_ - held_);
      loaded.put({false, job_.tile, 0, {from, from + static_cast<std::ptrdiff_t>(held_)}});
      held_ = 0;
      open_ = false;
    }
    if (block_done()) {
      do_ = chain_done ? Do::kNext : Do::kHead;
      return true;
    }
    if (!open_) {
      if (free_lists_ == 0) return false;
      --free_lists_;
      open_ = true;
    }
    read_entry();
    ++held_;
    return waits(1);
  }
  void read_entry() {
    ++read_;
    --blocks_.front().entries;
  }

  // As the second QSU: an entry is in its line in the third cycle. When all of a block are there,
  // the next block's turn comes.
  bool split_entry() {
    if (block_done()) {
      do_ = read_ < chain_.entries.size() ? Do::kHead : Do::kLines;
      return waits(ClockedSubsetLines::kBehindReading);
    }
    const std::uint32_t key = chain_.entries[read_].key;
    std::size_t subset = 0;
    for (const std::uint32_t pivot : pivots_) subset += key >= pivot ? 1 : 0;
    lines_.put(subset);
    read_entry();
    return waits(1);
  }
  // What is left in lines; when all is in memory the subsets are lists.
  bool flush() {
    if (!lines_.flushed(port_) || !port_.idle()) return false;
    const auto subsets = split_list(chain_.entries, pivots_);
    for (std::size_t s = subsets.size(); s-- > 0;) {
      chains_.push_back({subsets[s], chain_.level + 1});
    }
    do_ = Do::kNext;
    return true;
  }

  const SorterHardware hw_;
  std::uint32_t free_lists_;
  ClockedPort port_;
  Do do_ = Do::kRequest;
  std::uint32_t wait_ = 0;
  bool frame_ended_ = false;
  LoadedList job_;
  std::vector<Chain> chains_;  // the next one last
  Chain chain_;
  std::size_t asked_ = 0, read_ = 0, held_ = 0;  // entries of it
  bool splits_ = false, open_ = false, chosen_ = false;
  std::deque<Block> blocks_;
  std::array<std::uint32_t, kQsuPivots> pivots_{};
  ClockedSubsetLines lines_;
};

}  // namespace sgs::test
