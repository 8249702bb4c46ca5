// A line of a list of entries while it is combined on chip, and the blocks that a list lies in.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "algorithm/memory/tile_records.h"
#include "modules/datapath/selection.h"
#include "tlm/memory_port.h"

namespace sgs::gscore {

// End of a list: two numbers of blocks, a count. Hardware counts blocks, lines of the block and
// entries of the line, so that nothing is divided.
struct ListEnd {
  std::uint32_t block = 0, next = 0;  // the block that it writes in, and the next when that is full
  std::uint32_t entries = 0;
};

// Bytes that hardware keeps of a ListEnd where there are so many blocks.
inline std::uint32_t list_end_bytes(const BlockFormat& format, std::uint64_t blocks) {
  const std::uint32_t bits = 3 * counter_bits(blocks - 1) + counter_bits(format.block_lines - 1) +
                             counter_bits(format.line_entries());
  return (bits + 7) / 8;
}

// The bytes of a line that are not in memory yet.
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

// Lines are written by words of 64 bits and read by bursts: an entry spans three banks at most,
// with the link before it too.
constexpr std::uint32_t kLineWordBytes = 8, kLineBanks = kPortBytes / kLineWordBytes;
// Words of a line that these bytes of it lie in.
constexpr std::uint32_t line_words(std::uint32_t begin, std::uint32_t bytes) {
  return (begin + bytes - 1) / kLineWordBytes - begin / kLineWordBytes + 1;
}

// Places of a list's entries, for whoever appends.
struct EntryPlace {
  std::uint64_t line;  // number of the line in the region
  std::uint32_t at;    // in the line
  bool begins_line, begins_block, ends_line;
};
inline EntryPlace place_of(const BlockFormat& format, std::uint32_t block, std::uint32_t entry) {
  const std::uint32_t in_block = entry % format.block_entries();
  const std::uint32_t offset = format.offset(in_block);
  const std::uint32_t line = offset / format.line_bytes, at = offset % format.line_bytes;
  const std::uint32_t first_at = in_block < format.first_entries() ? kLinkBytes : 0;
  return {std::uint64_t{block} * format.block_lines + line, at, at == first_at, in_block == 0,
          at + 2 * format.entry.bytes() > format.line_bytes};
}

// Into a line that has begun; in front of the first of a block the link to the block behind it.
// Returns the words of the line that it writes.
inline std::uint32_t put_entry(const BlockFormat& format, const EntryPlace& place,
                               const TileEntry& entry, std::uint32_t next_block, LineBuffer& line) {
  std::byte bytes[kLinkBytes + 16];
  std::memcpy(bytes, &next_block, kLinkBytes);
  encode_entry(format.entry, entry, bytes + kLinkBytes);
  const std::uint32_t link = place.begins_block ? kLinkBytes : 0;
  line.put(place.at - link, bytes + kLinkBytes - link, link + format.entry.bytes());
  return line_words(place.at - link, link + format.entry.bytes());
}

}  // namespace sgs::gscore
