// Entries put into lines as they come, read back from the blocks that the lines become.
#include "modules/gscore/line_buffer.h"

#include <catch2/catch.hpp>
#include <cstring>
#include <vector>

namespace sgs::gscore {
namespace {

std::vector<EntryFormat> every_entry_format() {
  std::vector<EntryFormat> all;
  for (const NumberFormat keys : {NumberFormat::kHalf, NumberFormat::kSingle}) {
    for (const int across : {1, 2, 4}) {
      for (const NumberFormat features : {NumberFormat::kHalf, NumberFormat::kSingle}) {
        all.push_back({keys, across, features});
      }
    }
  }
  return all;
}

TEST_CASE("line buffer: what is put is where readers look, link and entries") {
  for (const EntryFormat& entry : every_entry_format()) {
    for (const std::uint32_t line_bytes : {32U, 64U, 128U}) {
      const BlockFormat format{entry, line_bytes, 3};
      INFO(line_bytes << " B, entries of " << format.entry.bytes());
      constexpr std::uint32_t kNext = 77;
      const std::uint32_t kOpacity = entry.opacity_bits() > 0 ? 0x3ffffe : 0;
      std::vector<std::byte> block(format.block_bytes());
      LineBuffer line(line_bytes);
      std::uint32_t lines = 0;
      for (std::uint32_t e = 0; e < format.block_entries(); ++e) {
        const EntryPlace place = place_of(format, 0, e);
        CHECK(place.begins_block == (e == 0));
        CHECK(place.begins_line == !line.holds_new());
        if (place.begins_line) line.begin(place.line, 0);
        const std::uint32_t words = put_entry(format, place, {e, e + 1, 1, kOpacity}, kNext, line);
        CHECK(words >= 1);
        CHECK(words <= 3);
        if (!place.ends_line) continue;
        ++lines;
        CHECK(line.address(line_bytes) == place.line * line_bytes);
        std::memcpy(block.data() + line.address(line_bytes), line.new_bytes(),
                    line.new_byte_count());
        line.written();
      }
      CHECK(lines == format.block_lines);
      std::uint32_t next;
      std::memcpy(&next, block.data(), sizeof next);
      CHECK(next == kNext);
      for (std::uint32_t e = 0; e < format.block_entries(); ++e) {
        const TileEntry got = decode_entry(format.entry, block.data() + format.offset(e));
        CHECK(got.key == e);
        CHECK(got.record == e + 1);
        CHECK(got.bitmap == 1);
        CHECK(got.opacity == kOpacity);
      }
      CHECK(format.used_bytes(format.block_entries()) <= format.block_bytes());
    }
  }
}

TEST_CASE("line buffer: only the first line of a block has a link") {
  const BlockFormat format{{NumberFormat::kHalf, 2}, 32, 16};
  CHECK(format.first_entries() == 4);
  CHECK(format.line_entries() == 5);
  CHECK(format.block_entries() == 4 + 15 * 5);
  CHECK(format.offset(3) == 4 + 3 * 6);
  CHECK(format.offset(4) == 32);
  CHECK(format.offset(9) == 64);
  // Two numbers of 19 bits and a count of blocks, four bits of lines, three of entries.
  CHECK(list_end_bytes(format, 1 << 19) == (3 * 19 + 4 + 3 + 7) / 8);
}

}  // namespace
}  // namespace sgs::gscore
