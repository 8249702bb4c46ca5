// A splat as bytes, as it lies on the chip between the units, and in the spill region.
#pragma once

#include <cstddef>
#include <cstdint>

#include "algorithm/splat/splat.h"

namespace sgs {

// Largest group whose sub-tile bounds fit a byte each.
constexpr int kMaxGroupPx = 255 * 4;

// 11 words, then the footprint cut to the group as four bytes relative to the group's first
// sub-tile.
constexpr std::uint32_t kSplatEntryBytes = 48;

// group: its sub-tiles. out: kSplatEntryBytes.
void encode_splat(const Splat& splat, const SubtileRect& group, std::byte* out);

// The footprint comes back cut to the group, which blends the same pixels of it.
Splat decode_splat(const std::byte* bytes, const SubtileRect& group);

}  // namespace sgs
