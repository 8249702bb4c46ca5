// Lists in memory as a tile sorter has them, and the lines in which the first QSU combines the
// entries of subsets: one is in its line two cycles behind its reading, and a full line leaves in
// that cycle.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>

#include "tests/modules/gscore/clocked/clocked_port.h"

namespace sgs::test {

struct SorterHardware {
  std::size_t chunk_entries = 256, list_entries = 1024;
  std::uint32_t list_buffers = 2;
  std::uint32_t line_bytes = 32, block_lines = 16, entry_bytes = 6, link_bytes = 4;
  std::uint32_t longest_bytes = 256;  // of a transaction; blocks begin with whole ones
  std::uint32_t latency = 40, write_latency = 150;
  std::size_t transactions = 16, writes = 2;  // unanswered at most

  std::size_t first_entries() const { return (line_bytes - link_bytes) / entry_bytes; }
  std::size_t line_entries() const { return line_bytes / entry_bytes; }
  std::size_t block_entries() const { return first_entries() + (block_lines - 1) * line_entries(); }

  // Of a block with so many entries: its first line, then what is behind it.
  std::uint32_t transactions_of(std::size_t entries) const {
    if (entries <= first_entries()) return 1;
    const std::size_t behind = entries - first_entries() - 1;  // the last one's place
    const std::size_t bytes =
        (1 + behind / line_entries()) * line_bytes + (behind % line_entries() + 1) * entry_bytes;
    const std::size_t first = line_bytes / longest_bytes, last = (bytes - 1) / longest_bytes;
    return static_cast<std::uint32_t>(1 + last - first + 1);
  }
  // Entries in the last line of a list of so many; none where it is full.
  std::size_t in_line(std::size_t entries) const {
    const std::size_t in_block = entries % block_entries();
    if (in_block < first_entries()) return in_block;
    return (in_block - first_entries()) % line_entries();
  }
};

class ClockedSubsetLines {
 public:
  static constexpr std::uint32_t kBehindReading = 2;  // cycles

  explicit ClockedSubsetLines(const SorterHardware& hardware) : hw_(hardware) {}

  void begin() { entries_.fill(0); }
  // An entry that is read in this cycle.
  void put(std::size_t subset) {
    const bool fills = hw_.in_line(++entries_[subset]) == 0;
    under_way_.push_back({1 + kBehindReading, fills});
  }
  // Before anything is read: false where a line that is full cannot leave, and all stands.
  bool leave(ClockedTwoWayPort& port) {
    if (under_way_.empty()) return true;
    const bool sends = under_way_.front().left == 1 && under_way_.front().fills;
    if (sends && !port.can_write()) return false;
    if (sends) port.write();
    for (UnderWay& entry : under_way_) --entry.left;
    if (under_way_.front().left == 0) under_way_.pop_front();
    return true;
  }
  // What is left in lines leaves, one a cycle; true when none is.
  bool flushed(ClockedTwoWayPort& port) {
    const auto holds = [&](std::size_t entries) { return hw_.in_line(entries) > 0; };
    const auto line = std::find_if(entries_.begin(), entries_.end(), holds);
    if (line == entries_.end()) return true;
    if (!port.can_write()) return false;
    port.write();
    *line = 0;
    return false;
  }

 private:
  struct UnderWay {
    std::uint32_t left;  // cycles
    bool fills;          // its line
  };
  const SorterHardware hw_;
  std::array<std::size_t, 8> entries_{};  // [subset]
  std::deque<UnderWay> under_way_;
};

}  // namespace sgs::test
