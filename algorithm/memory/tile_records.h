// The records of a tile-centric machine (as GSCore, ASPLOS 2024) between projection and rendering:
// the projected Gaussian, and the entries of the tiles' lists.
#pragma once

#include <cstddef>
#include <cstdint>

#include "algorithm/memory/number_format.h"
#include "algorithm/splat/splat.h"
#include "algorithm/splat/square_conic.h"

namespace sgs {

// Projected Gaussians. kSingle: x, y, conic, colour as 32-bit floats. With the opacity they would
// take a second burst. One that can be seen, 1/255 to 1, is a number of 27 bits: 5 stand where the
// signs of A, C and the colour would, which have none; the others go with each entry. kHalf: x and
// y so (a half counts places above 512 px by halves of one), then the conic with its square
// completed (square_conic.h; of three halved terms, which cancel, it would be lost), opacity and
// colour as halves; the conic in units of its own along x and y, whose exponents are the last two
// bytes: wide splats do not vanish among the subnormal. A place is a whole burst, since records are
// read one here, one there.
constexpr std::uint32_t record_bytes(NumberFormat format) {
  return format == NumberFormat::kHalf ? 24 : 32;
}
constexpr std::uint32_t kRecordPlaceBytes = 32;
void encode_projected(NumberFormat format, const Splat& splat, std::byte* out);
// The part of an opacity that each entry holds; 0 with halves.
std::uint32_t listed_opacity(NumberFormat format, float opacity);
// Without depth, index and footprint, which the lists hold. A Gaussian that cannot be seen has no
// opacity.
Splat decode_projected(NumberFormat format, const std::byte* bytes, std::uint32_t listed_opacity);
// The same for blending in half.
SquareSplat decode_square(NumberFormat format, const std::byte* bytes,
                          std::uint32_t listed_opacity);

// The depth as a key, larger for what is farther: its bits, of the float or of the nearest half.
std::uint32_t depth_key(NumberFormat format, float depth);

struct TileEntry {
  std::uint32_t key = 0;
  std::uint32_t record = 0;   // number of the projected Gaussian
  std::uint32_t bitmap = 0;   // one bit for each part of the tile
  std::uint32_t opacity = 0;  // listed_opacity()
};

// Key, then the record's number with the bitmap and what there is of the opacity above it; a bitmap
// of 16 bits stands behind. A depth has no sign: its place is the number's highest bit.
struct EntryFormat {
  NumberFormat keys = NumberFormat::kHalf;
  int subtiles_across = 2;
  NumberFormat features = NumberFormat::kHalf;  // format of records

  std::uint32_t key_bytes() const { return keys == NumberFormat::kHalf ? 2 : 4; }
  bool wide() const { return subtiles_across > 2; }
  std::uint32_t opacity_bits() const { return features == NumberFormat::kHalf ? 0 : 22; }
  std::uint32_t bitmap_bits() const { return wide() ? 0 : 4; }
  std::uint32_t word_bytes() const { return features == NumberFormat::kHalf ? 4 : 6; }
  // Bits of the record's number in the word.
  std::uint32_t number_bits() const { return 8 * word_bytes() - bitmap_bits() - opacity_bits(); }
  std::uint32_t bytes() const { return key_bytes() + word_bytes() + (wide() ? 2 : 0); }
  // Most records that an entry tells apart.
  std::uint64_t records() const {
    return std::uint64_t{1} << (number_bits() < 32 ? number_bits() + 1 : 32);
  }
};
void encode_entry(const EntryFormat& format, const TileEntry& entry, std::byte* out);
TileEntry decode_entry(const EntryFormat& format, const std::byte* bytes);

// Lists lie in blocks of lines, each of whole entries. The first line of a block begins with a
// link, the number of the next block.
constexpr std::uint32_t kLinkBytes = 4;
struct BlockFormat {
  EntryFormat entry;
  std::uint32_t line_bytes = 64, block_lines = 8;

  // Entries of a block's first line, and of each other one.
  std::uint32_t first_entries() const { return (line_bytes - kLinkBytes) / entry.bytes(); }
  std::uint32_t line_entries() const { return line_bytes / entry.bytes(); }
  std::uint32_t block_entries() const {
    return first_entries() + (block_lines - 1) * line_entries();
  }
  std::uint32_t block_bytes() const { return block_lines * line_bytes; }
  // The place of an entry in bytes from the beginning of its block; `at` counts entries of the
  // list.
  std::uint32_t offset(std::uint64_t at) const {
    const auto in_block = static_cast<std::uint32_t>(at % block_entries());
    if (in_block < first_entries()) return kLinkBytes + in_block * entry.bytes();
    const std::uint32_t behind = in_block - first_entries();
    return (1 + behind / line_entries()) * line_bytes + behind % line_entries() * entry.bytes();
  }
  // Bytes of a block that holds so many entries, to the end of the last.
  std::uint32_t used_bytes(std::uint32_t entries) const {
    return entries == 0 ? 0 : offset(entries - 1) + entry.bytes();
  }
};

}  // namespace sgs
