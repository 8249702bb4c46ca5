// The shape of pixel groups: which size costs a frame least, and how a group is cut into parts.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "algorithm/splat/rects.h"

namespace sgs {

// Px of the borders between groups of this size, over all frames. Every Gaussian that lies on one
// is fetched for both sides.
std::uint64_t border_px(const std::vector<PixelSize>& frames, const PixelSize& group);

// The size that has the shortest borders of those that fit; of several the one with the fewest
// pixels, then the widest. Sides are multiples of step_px up to most_px. fits(): a size that fits
// still does when it gets narrower or lower. 0 x 0 where nothing fits.
PixelSize group_for_frame(const std::vector<PixelSize>& frames, int step_px, int most_px,
                          const std::function<bool(const PixelSize&)>& fits);

// A pixel group cut into parts, each filtered and blended by itself: as many columns as rows of
// them, all of one size.

// Whole square root of a number of parts, or 0 where it has none.
std::uint32_t parts_across(std::uint32_t parts);

// Both sides of a group are to be multiples of this, in px: then parts are whole 4x4 sub-tiles.
std::uint32_t group_step_px(std::uint32_t parts);

// Size of a part of such a group.
PixelSize part_size(const PixelSize& group, std::uint32_t parts);

// [part][group] pixels, cut to the group; empty where nothing of the part lies in the frame.
// parts: a square number; group: multiples of group_step_px().
std::vector<std::vector<PixelRect>> group_parts(const std::vector<PixelRect>& groups,
                                                const PixelSize& group, std::uint32_t parts);

}  // namespace sgs
