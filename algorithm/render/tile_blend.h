// One entry of a tile's list blended into the tile: the parts of the tile whose bits are set.
#pragma once

#include <cstdint>

#include "algorithm/memory/tile_records.h"
#include "algorithm/render/group_state.h"
#include "algorithm/splat/tile_boxes.h"

namespace sgs {

// Calls visit(splat) with what record and entry hold, as blending in that precision takes it: a
// Splat or a SquareSplat.
template <class Visit>
void with_record(NumberFormat format, BlendPrecision precision, const std::byte* record,
                 std::uint32_t listed_opacity, const Visit& visit) {
  if (in_16_bits(precision)) {
    visit(decode_square(format, record, listed_opacity));
  } else {
    visit(decode_projected(format, record, listed_opacity));
  }
}

// Calls blend(splat, part) with a footprint for each part of the tile (in tiles of the frame) whose
// bit is set.
template <class AnySplat, class Blend>
void for_each_part(const TileRules& rules, int tile_x, int tile_y, std::uint32_t bitmap,
                   AnySplat splat, const Blend& blend) {
  const int across = rules.subtiles_across, side = kSubtilesPerTile / across;
  const auto of_frame = [](int at) { return static_cast<std::uint16_t>(at); };
  for (int part = 0; part < across * across; ++part) {
    if ((bitmap >> part & 1U) == 0) continue;
    const int x = tile_x * kSubtilesPerTile + part % across * side;
    const int y = tile_y * kSubtilesPerTile + part / across * side;
    splat.footprint = {of_frame(x), of_frame(y), of_frame(x + side), of_frame(y + side)};
    blend(static_cast<const AnySplat&>(splat), part);
  }
}

}  // namespace sgs
