// Messages between the units of the tile-centric machine. kSramBytes: bytes that hardware keeps of
// a message that waits.
#pragma once

#include <cstdint>

#include "algorithm/memory/record_split.h"
#include "algorithm/memory/tile_records.h"
#include "algorithm/splat/tile_boxes.h"

namespace sgs::gscore {

// Lister -> CCUs, or the culler ahead of them: project the scene for tiles [first, end), row by
// row; or the frame is over.
struct Pass {
  static constexpr std::uint32_t kSramBytes = 8;
  std::uint32_t first = 0, end = 0;
  bool over = false;
};

// Within the culler: a chunk whose box touches the frame, or the end of its pass, or of the frame.
struct VisibleChunk {
  static constexpr std::uint32_t kSramBytes = 7;  // first, count, marks
  std::uint32_t first = 0, count = 0, frame = 0;
  bool end_of_pass = false, over = false;
};

// Culler -> CCU: neighbours in memory to be projected, none where a pass has nothing else to end
// with; or the frame is over.
struct VisibleSlice {
  static constexpr std::uint32_t kSramBytes = 6;  // first, count, marks
  std::uint32_t first = 0, count = 0;
  std::uint32_t frame = 0;
  bool end_of_pass = false;  // the last one of its pass
  bool over = false;
};

// Within a CCU: a Gaussian that may touch the frame, or the end of a slice whose last Gaussian
// cannot.
struct Candidate {
  static constexpr std::uint32_t kSramBytes = 20;  // slot, centre, a word of the first half
  static std::uint32_t sram_bytes(std::uint32_t carried_words) {
    return kSramBytes + 4 * (carried_words - 1);
  }
  bool there = false;        // a Gaussian
  bool last = false;         // last of its slice
  bool end_of_pass = false;  // and that the last one of the pass
  bool over = false;         // no more slices
  std::uint32_t slot = 0, frame = 0;
  SplitFirstHalf first{};
  std::uint64_t ticket = 0;  // read of the second half
  std::uint32_t buffer = 0;  // where it lands
};

// CCU -> lister: a Gaussian with its boxes, or the end of a slice whose last Gaussian has none.
// Of two eyes this is what the left one sees of it.
struct ConvertedForEye {
  bool there = false;
  Splat splat{};
  TileBoxes boxes{};
};
struct Converted : ConvertedForEye {
  // Record, key, tiles, parts, box, its limits: a word of an eye that sees it.
  static constexpr std::uint32_t kSramBytes = 108;
  bool last = false;
  bool end_of_pass = false;  // last of the last slice
  ConvertedForEye right;     // the right eye's, where there are two

  bool any_there() const { return there || right.there; }
};

// Sorter -> lister: a tile is wanted.
struct TileRequest {
  static constexpr std::uint32_t kSramBytes = 1;
};
enum class TileMark : std::uint8_t { kTile, kEndOfPass, kEndOfFrame };
// Lister -> sorter.
struct TileJob {
  static constexpr std::uint32_t kSramBytes = 12;
  TileMark mark = TileMark::kTile;
  std::uint32_t tile = 0;         // tile of the frame
  std::uint32_t first_block = 0;  // first block in the pool
  std::uint32_t entries = 0;      // entries of its list
  std::uint32_t set = 0;          // of lists and records
};

// Sorter -> rendering: entries of a tile in order, then its end.
enum class EntryMark : std::uint8_t { kEntry, kEndOfTile, kEndOfPass, kEndOfFrame };
constexpr bool of_tile(EntryMark mark) {
  return mark == EntryMark::kEntry || mark == EntryMark::kEndOfTile;
}
struct SortedEntry {
  static constexpr std::uint32_t kSramBytes = 8;  // record, bitmap, tile, mark
  static std::uint32_t sram_bytes(const EntryFormat& format) {
    return kSramBytes + (format.opacity_bits() + 7) / 8;
  }
  EntryMark mark = EntryMark::kEntry;
  std::uint32_t tile = 0, record = 0, bitmap = 0;
  std::uint32_t opacity = 0;  // listed_opacity()
  std::uint32_t set = 0;      // of records
};

// Rendering -> lister: the last tile of the pass is in memory.
struct PassDone {
  static constexpr std::uint32_t kSramBytes = 1;
};

}  // namespace sgs::gscore
