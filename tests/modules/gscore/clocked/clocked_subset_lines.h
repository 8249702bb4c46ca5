// Lists in memory as a tile sorter has them, and the lines in which the first QSU combines the
// entries of subsets: one is in its line two cycles behind its reading, and a full line leaves in
// that cycle.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>

#include "tests/modules/clocked/clocked_port.h"

namespace sgs::test {

struct SorterHardware {
  std::size_t chunk_entries = 256, list_entries = 1024;
  std::uint32_t list_buffers = 2;
  std::uint32_t line_bytes = 32, block_lines = 16, entry_bytes = 6, link_bytes = 4;
  PortHardware port = {};  // blocks begin with whole transactions

  std::size_t first_entries() const { return (line_bytes - link_bytes) / entry_bytes; }
  std::size_t line_entries() const { return line_bytes / entry_bytes; }
  std::size_t block_entries() const { return first_entries() + (block_lines - 1) * line_entries(); }

  // Of a block with so many entries, as far as it is used.
  std::size_t used_bytes(std::size_t entries) const {
    if (entries <= first_entries()) return link_bytes + entries * entry_bytes;
    const std::size_t behind = entries - first_entries() - 1;  // the last one's place
    return (1 + behind / line_entries()) * line_bytes + (behind % line_entries() + 1) * entry_bytes;
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
  bool leave(ClockedPort& port) {
    if (under_way_.empty()) return true;
    const bool sends = under_way_.front().left == 1 && under_way_.front().fills;
    if (sends && !write(port, hw_.line_bytes)) return false;
    for (UnderWay& entry : under_way_) --entry.left;
    if (under_way_.front().left == 0) under_way_.pop_front();
    return true;
  }
  // What is left in lines leaves, one a cycle; true when none is.
  bool flushed(ClockedPort& port) {
    const auto holds = [&](std::size_t entries) { return hw_.in_line(entries) > 0; };
    const auto line = std::find_if(entries_.begin(), entries_.end(), holds);
    if (line == entries_.end()) return true;
    const std::size_t first =
        *line % hw_.block_entries() < hw_.first_entries() ? hw_.link_bytes : 0;
    if (write(port, first + hw_.in_line(*line) * hw_.entry_bytes)) *line = 0;
    return false;
  }

 private:
  // In one transaction.
  static bool write(ClockedPort& port, std::size_t bytes) {
    ClockedTransfer what{0, bytes};
    return port.write(what);
  }
  struct UnderWay {
    std::uint32_t left;  // cycles
    bool fills;          // its line
  };
  const SorterHardware hw_;
  std::array<std::size_t, 8> entries_{};  // [subset]
  std::deque<UnderWay> under_way_;
};

}  // namespace sgs::test
