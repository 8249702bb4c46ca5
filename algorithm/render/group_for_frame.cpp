// For each width the tallest group that fits, and the lowest that saves as much.
#include "algorithm/render/group_for_frame.h"

#include <tuple>

namespace sgs {
namespace {

std::uint64_t borders_between(int frame_px, int side_px) {
  return static_cast<std::uint64_t>((frame_px + side_px - 1) / side_px - 1);
}

}  // namespace

std::uint64_t border_px(const std::vector<PixelSize>& frames, const PixelSize& group) {
  std::uint64_t sum = 0;
  for (const PixelSize& frame : frames) {
    sum += borders_between(frame.width, group.width) * static_cast<std::uint64_t>(frame.height) +
           borders_between(frame.height, group.height) * static_cast<std::uint64_t>(frame.width);
  }
  return sum;
}

PixelSize group_for_frame(const std::vector<PixelSize>& frames, int step_px, int most_px,
                          const std::function<bool(const PixelSize&)>& fits) {
  PixelSize best;
  const auto cost = [&](const PixelSize& group) {
    return std::tuple(border_px(frames, group), group.width * group.height, -group.width);
  };
  int tallest = most_px / step_px * step_px;
  for (int width = step_px; width <= most_px; width += step_px) {
    while (tallest > 0 && !fits({width, tallest})) tallest -= step_px;
    for (int height = tallest; height > 0; height -= step_px) {
      const PixelSize group{width, height};
      if (border_px(frames, group) > border_px(frames, {width, tallest})) break;
      if (best == PixelSize{} || cost(group) < cost(best)) best = group;
    }
  }
  return best;
}

}  // namespace sgs
