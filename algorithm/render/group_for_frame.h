// The shape of pixel groups that costs a frame least, where a configuration leaves it open.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "algorithm/splat/rects.h"

namespace sgs {

// Px of the borders between groups of this size, over all frames. Every Gaussian that lies on one
// is fetched for both sides.
std::uint64_t border_px(const std::vector<PixelSize>& frames, const PixelSize& group);

// Of the sizes that fit the one with the shortest borders; of several the one with the fewest
// pixels, then the widest. Sides are multiples of step_px up to most_px. fits(): what fits still
// does when it gets narrower or lower. 0 x 0 where nothing fits.
PixelSize group_for_frame(const std::vector<PixelSize>& frames, int step_px, int most_px,
                          const std::function<bool(const PixelSize&)>& fits);

}  // namespace sgs
