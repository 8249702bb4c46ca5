// A pixel group cut into parts, each filtered and blended by itself: as many columns as rows of
// them, all of one size.
#pragma once

#include <cstdint>
#include <vector>

#include "algorithm/splat/rects.h"

namespace sgs {

// Whole square root of a number of parts, or 0 where it has none.
std::uint32_t parts_across(std::uint32_t parts);

// Of which both sides of a group are to be multiples: then parts are whole 4x4 sub-tiles.
std::uint32_t group_step_px(std::uint32_t parts);

// Size of a part of such a group.
PixelSize part_size(const PixelSize& group, std::uint32_t parts);

// [part][group] pixels, cut to the group; empty where nothing of the part lies in the frame.
// parts: a square number; group: multiples of group_step_px().
std::vector<std::vector<PixelRect>> group_parts(const std::vector<PixelRect>& groups,
                                                const PixelSize& group, std::uint32_t parts);

}  // namespace sgs
