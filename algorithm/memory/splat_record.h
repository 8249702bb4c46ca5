// A splat as bytes, as it lies in SRAM between the units and in the spill region of the DRAM.
#pragma once

#include <cstddef>

#include "algorithm/splat/splat.h"

namespace sgs {

// Largest group whose sub-tile bounds fit a byte each.
constexpr int kMaxGroupPx = 255 * 4;

// kSplatEntryBytes: 11 words, then the footprint cut to the group as four bytes relative to the
// group's first sub-tile. group: the group's sub-tiles.
void encode_splat(const Splat& splat, const SubtileRect& group, std::byte* out);

// The footprint comes back cut to the group, which blends the same pixels of it.
Splat decode_splat(const std::byte* bytes, const SubtileRect& group);

}  // namespace sgs
