// A splat as bytes, as it lies on the chip between the units, and in the spill region.
#pragma once

#include <cstddef>
#include <cstdint>

#include "algorithm/memory/number_format.h"
#include "algorithm/splat/splat.h"

namespace sgs {

// Largest group whose sub-tile bounds fit a byte each.
constexpr int kMaxGroupPx = 255 * 4;

// 11 words, then the footprint cut to the group as four bytes relative to the group's first
// sub-tile.
constexpr std::uint32_t kSplatEntryBytes = 48;

// kHalf: a projected Gaussian in halves (tile_records.h), depth, index, and the footprint so.
constexpr std::uint32_t splat_entry_bytes(NumberFormat format) {
  return format == NumberFormat::kHalf ? 36 : kSplatEntryBytes;
}

// group: its sub-tiles. out: splat_entry_bytes().
void encode_splat(NumberFormat format, const Splat& splat, const SubtileRect& group,
                  std::byte* out);

// The footprint comes back cut to the group, which blends the same pixels of it.
Splat decode_splat(NumberFormat format, const std::byte* bytes, const SubtileRect& group);

// The splat that comes back from its entry, with its whole footprint.
Splat rounded_splat(NumberFormat format, const Splat& splat);

}  // namespace sgs
