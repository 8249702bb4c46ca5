// A line of a list of entries while it is combined on chip, and the blocks that a list lies in.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "algorithm/memory/tile_records.h"
#include "tlm/memory_port.h"

namespace sgs::gscore {

// Where the end of a list is: two numbers of blocks, a count.
struct ListEnd {
  static constexpr std::uint32_t kBytes = 9;  // 24 bits each
  std::uint32_t block = 0, next = 0;          // that it writes in, and will when that is full
  std::uint32_t entries = 0;
};

// What of a line is not in memory yet.
class LineBuffer {
 public:
  // line: its number from the beginning of the region on.
  void begin(std::uint64_t line, std::uint32_t from) {
    line_ = line;
    begin_ = end_ = from;
  }
  void put(std::uint32_t at, const std::byte* from, std::uint32_t bytes) {
    std::memcpy(bytes_.data() + at, from, bytes);
    end_ = std::max(end_, at + bytes);
  }
  bool holds_new() const { return end_ > begin_; }
  std::uint64_t address(std::uint32_t line_bytes) const { return line_ * line_bytes + begin_; }
  const std::byte* new_bytes() const { return bytes_.data() + begin_; }
  std::uint32_t new_byte_count() const { return end_ - begin_; }
  // All of it is in memory now.
  void written() { begin_ = end_; }

  explicit LineBuffer(std::uint32_t line_bytes) : bytes_(line_bytes) {}

 private:
  std::vector<std::byte> bytes_;
  std::uint64_t line_ = 0;
  std::uint32_t begin_ = 0, end_ = 0;
};

// Lines are written by words of 64 bits and read by bursts: an entry spans two banks at most.
constexpr std::uint32_t kLineWordBytes = 8, kLineBanks = kPortBytes / kLineWordBytes;
// Words of a line that these bytes of it lie in.
constexpr std::uint32_t line_words(std::uint32_t begin, std::uint32_t bytes) {
  return (begin + bytes - 1) / kLineWordBytes - begin / kLineWordBytes + 1;
}

// Places of a list's entries, for whoever appends.
struct EntryPlace {
  std::uint64_t line;  // of the region
  std::uint32_t at;    // in the line
  bool begins_line, begins_block, ends_line;
};
inline EntryPlace place_of(const BlockFormat& format, std::uint32_t block, std::uint32_t entry) {
  const std::uint32_t in_block = entry % format.block_entries();
  const std::uint32_t in_line = in_block % format.line_entries();
  return {std::uint64_t{block} * format.block_lines + in_block / format.line_entries(),
          kLinkBytes + in_line * format.entry.bytes(), in_line == 0, in_block == 0,
          in_line + 1 == format.line_entries()};
}

}  // namespace sgs::gscore
