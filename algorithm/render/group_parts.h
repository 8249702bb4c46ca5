// A pixel group cut into parts, each filtered and blended by itself: a square grid of them, of
// whole 4x4 sub-tiles.
#pragma once

#include <cstdint>
#include <vector>

#include "algorithm/splat/rects.h"

namespace sgs {

// Whole square root of a number of parts, or 0 where it has none.
std::uint32_t parts_across(std::uint32_t parts);

// Side in px of the widest part of a group of group_px.
std::uint32_t part_px(std::uint32_t group_px, std::uint32_t parts);

// [part][group] pixels, cut to the group; empty where nothing of the part lies in the frame, or
// where the group has fewer sub-tiles than parts. parts: a square number.
std::vector<std::vector<PixelRect>> group_parts(const std::vector<PixelRect>& groups,
                                                std::uint32_t group_px, std::uint32_t parts);

}  // namespace sgs
