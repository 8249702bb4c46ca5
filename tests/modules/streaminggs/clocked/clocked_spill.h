// The merge unit's way to DRAM register by register: what is asked of its port in turn, runs of
// keys with two blocks each, of which one is read and one is on its way, and the block that is
// written. One thing at a time: a run is read from once all of it is written.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <iterator>
#include <list>
#include <optional>
#include <vector>

#include "tests/modules/clocked/clocked_port.h"

namespace sgs::test {

struct SpillHardware {
  std::uint32_t runs = 8, block_entries = 8;
  PortHardware port = {};
  std::uint64_t base = 0, area_bytes = 0;  // of the first of two areas
};
constexpr std::uint32_t kSpilledKeyBytes = 32;

// One thing after the other leaves.
class ClockedSpillPort {
 public:
  explicit ClockedSpillPort(const SpillHardware& hardware) : port_(hardware.port) {}

  void read(ClockedTransfer& what) { asked_.push_back({&what, {}}); }
  void write(const ClockedTransfer& what) { asked_.push_back({nullptr, what}); }
  bool has_asked() const { return asked_.empty(); }
  bool answered(const ClockedTransfer& read) const { return port_.answered(read); }
  bool idle() const { return has_asked() && port_.idle(); }
  void begin_cycle() {
    port_.begin_cycle();
    ask();
  }
  void ask() {
    while (!asked_.empty()) {
      Asked& next = asked_.front();
      if (!(next.read != nullptr ? port_.read(*next.read) : port_.write(next.written))) return;
      asked_.pop_front();
    }
  }

 private:
  struct Asked {
    ClockedTransfer* read;  // null: a write
    ClockedTransfer written;
  };
  ClockedPort port_;
  std::deque<Asked> asked_;
};

struct ClockedRun {
  std::uint64_t address = 0;
  std::deque<std::uint64_t> keys;  // in final order; not yet taken
  std::size_t unasked = 0, taken = 0;
  ClockedTransfer blocks[2];

  void ask(ClockedSpillPort& port, const SpillHardware& hw, std::uint32_t block) {
    const std::size_t entries = std::min<std::size_t>(unasked, hw.block_entries);
    if (entries == 0) return;
    const std::size_t first = taken + keys.size() - unasked;
    blocks[block] = {address + first * kSpilledKeyBytes, entries * kSpilledKeyBytes};
    port.read(blocks[block]);
    unasked -= entries;
  }
  bool front_is_there(const ClockedSpillPort& port, const SpillHardware& hw) const {
    return port.answered(blocks[taken / hw.block_entries % 2]);
  }
  // The block that is read to its end is asked for again.
  void take(ClockedSpillPort& port, const SpillHardware& hw) {
    keys.pop_front();
    ++taken;
    if (keys.empty() || taken % hw.block_entries != 0) return;
    ask(port, hw, static_cast<std::uint32_t>(taken / hw.block_entries + 1) % 2);
  }
};

class ClockedSpill {
 public:
  explicit ClockedSpill(const SpillHardware& hardware) : hw_(hardware), port_(hardware) {}

  void step_port() { port_.begin_cycle(); }
  bool at_work() const { return phase_ != Phase::kNone; }
  // What was asked for has left, and the nearest key of each run is there.
  bool ready() const { return port_.has_asked() && fronts_are_there(runs_); }
  std::optional<std::uint64_t> nearest() const {
    if (runs_.empty()) return {};
    return nearest_of(runs_)->keys.front();
  }
  void take_nearest() { take_from(runs_); }
  void end_group() { used_ = spills_ = 0; }

  // The heap is full, with so many keys.
  void begin(std::size_t keys) {
    const bool all_runs = runs_.size() == hw_.runs;
    const std::uint32_t eighths = std::min(4U, 1 + spills_++ / hw_.runs);
    to_spill_ = std::max<std::size_t>(1, keys * eighths / 8);
    if (all_runs) {
      merge(shortest());
    } else {
      spill();
    }
  }

  // farthest(): of the heap, if it begins an operation in this cycle.
  template <class Farthest>
  void step(const Farthest& farthest) {
    while (at_work() && port_.has_asked()) {
      if (phase_ == Phase::kMerging) {
        if (fronts_are_there(merging_)) write_nearest();
        return;
      }
      if (phase_ == Phase::kSpilling) {
        if (const std::optional<std::uint64_t> key = farthest()) write_farthest(*key);
        return;
      }
      if (phase_ == Phase::kWritten) {
        if (!port_.idle()) return;
        open_run();
        port_.ask();
      } else if (runs_.back().front_is_there(port_, hw_)) {
        opened();
      } else {
        return;
      }
    }
  }

 private:
  enum class Phase { kNone, kMerging, kSpilling, kWritten, kOpening };
  using Runs = std::list<ClockedRun>;

  bool fronts_are_there(const Runs& runs) const {
    return std::all_of(runs.begin(), runs.end(),
                       [&](const ClockedRun& run) { return run.front_is_there(port_, hw_); });
  }
  template <class AnyRuns>
  static auto nearest_of(AnyRuns& runs) -> decltype(runs.begin()) {
    return std::min_element(runs.begin(), runs.end(), [](const auto& a, const auto& b) {
      return a.keys.front() < b.keys.front();
    });
  }
  void take_from(Runs& runs) {
    const auto run = nearest_of(runs);
    run->take(port_, hw_);
    if (run->keys.empty()) runs.erase(run);
  }
  bool fits(std::size_t keys) const { return used_ + keys * kSpilledKeyBytes <= hw_.area_bytes; }

  // How many of the shortest runs become one: two, and those that are no more than twice as long as
  // all before them together.
  std::size_t shortest() {
    runs_.sort(
        [](const ClockedRun& a, const ClockedRun& b) { return a.keys.size() < b.keys.size(); });
    std::size_t count = 0, keys = 0;
    for (const ClockedRun& run : runs_) {
      if (count >= 2 && run.keys.size() > 2 * keys) break;
      keys += run.keys.size();
      ++count;
    }
    return fits(keys) ? count : runs_.size();
  }
  // All of them go to the other area.
  void merge(std::size_t count) {
    if (count == runs_.size()) {
      area_ ^= 1U;
      used_ = 0;
    }
    merging_.splice(merging_.begin(), runs_, runs_.begin(),
                    std::next(runs_.begin(), static_cast<std::ptrdiff_t>(count)));
    begin_run(Phase::kMerging);
  }
  void spill() {
    if (!fits(to_spill_)) {
      if (!runs_.empty()) return merge(runs_.size());
      area_ ^= 1U;
      used_ = 0;
    }
    begin_run(Phase::kSpilling);
  }
  void begin_run(Phase phase) {
    phase_ = phase;
    merges_ = phase == Phase::kMerging;
    written_ = {};
    written_.address = hw_.base + area_ * hw_.area_bytes + used_;
  }

  // From the front, with what is nearest of all that become one.
  void write_nearest() {
    const auto run = nearest_of(merging_);
    written_.keys.push_back(run->keys.front());
    const std::size_t in_block = (written_.keys.size() - 1) % hw_.block_entries + 1;
    const bool last = merging_.size() == 1 && run->keys.size() == 1;
    if (in_block == hw_.block_entries || last) write(written_.keys.size() - in_block, in_block);
    take_from(merging_);
    if (last) phase_ = Phase::kWritten;
  }
  // From the back.
  void write_farthest(std::uint64_t key) {
    written_.keys.push_front(key);
    const std::size_t at = to_spill_ - written_.keys.size();
    if (at % hw_.block_entries == 0) {
      write(at, std::min<std::size_t>(hw_.block_entries, to_spill_ - at));
    }
    if (at == 0) phase_ = Phase::kWritten;
  }
  void write(std::size_t first, std::size_t keys) {
    port_.write({written_.address + first * kSpilledKeyBytes, keys * kSpilledKeyBytes});
  }
  void open_run() {
    phase_ = Phase::kOpening;
    used_ += written_.keys.size() * kSpilledKeyBytes;
    runs_.push_back(written_);
    ClockedRun& run = runs_.back();
    run.unasked = run.keys.size();
    for (std::uint32_t block = 0; block < 2; ++block) run.ask(port_, hw_, block);
  }
  void opened() {
    phase_ = Phase::kNone;
    if (merges_) spill();
  }

  const SpillHardware hw_;
  ClockedSpillPort port_;
  Phase phase_ = Phase::kNone;
  Runs runs_, merging_;
  ClockedRun written_;   // that is being written
  bool merges_ = false;  // then there is a spill to come
  std::size_t to_spill_ = 0;
  std::uint32_t spills_ = 0, area_ = 0;
  std::uint64_t used_ = 0;  // bytes of the area
};

}  // namespace sgs::test
