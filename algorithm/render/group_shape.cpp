// The search for the size, and where the parts of a group lie.
#include "algorithm/render/group_shape.h"

#include <tuple>

#include "algorithm/splat/constants.h"

namespace sgs {

// For each width the tallest group that fits, and the lowest that saves as much.

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

namespace {

PixelRect part_of(const PixelRect& group, int column, int row, const PixelSize& part) {
  const int x = group.x0 + column * part.width, y = group.y0 + row * part.height;
  const PixelRect cut = intersection({x, y, x + part.width, y + part.height}, group);
  return cut.empty() ? PixelRect{x, y, x, y} : cut;
}

}  // namespace

std::uint32_t parts_across(std::uint32_t parts) {
  std::uint32_t across = 1;
  while (across * across < parts) ++across;
  return across * across == parts ? across : 0;
}

std::uint32_t group_step_px(std::uint32_t parts) { return parts_across(parts) * kSubtilePx; }

PixelSize part_size(const PixelSize& group, std::uint32_t parts) {
  const auto across = static_cast<int>(parts_across(parts));
  return {group.width / across, group.height / across};
}

std::vector<std::vector<PixelRect>> group_parts(const std::vector<PixelRect>& groups,
                                                const PixelSize& group, std::uint32_t parts) {
  const std::uint32_t across = parts_across(parts);
  const PixelSize size = part_size(group, parts);
  std::vector<std::vector<PixelRect>> out(parts);
  for (std::uint32_t p = 0; p < parts; ++p) {
    for (const PixelRect& of : groups) {
      out[p].push_back(
          part_of(of, static_cast<int>(p % across), static_cast<int>(p / across), size));
    }
  }
  return out;
}

}  // namespace sgs
