// Where the parts of a group lie.
#include "algorithm/render/group_parts.h"

#include "algorithm/splat/constants.h"

namespace sgs {
namespace {

// First sub-tile of part `at` of a side of `subtiles`.
std::uint32_t first_subtile(std::uint32_t at, std::uint32_t subtiles, std::uint32_t across) {
  return at * subtiles / across;
}

PixelRect part_of(const PixelRect& group, std::uint32_t column, std::uint32_t row,
                  std::uint32_t subtiles, std::uint32_t across) {
  const auto px = [&](std::uint32_t at) {
    return static_cast<int>(first_subtile(at, subtiles, across)) * kSubtilePx;
  };
  const PixelRect whole{group.x0 + px(column), group.y0 + px(row), group.x0 + px(column + 1),
                        group.y0 + px(row + 1)};
  const PixelRect cut = intersection(whole, group);
  return cut.empty() ? PixelRect{whole.x0, whole.y0, whole.x0, whole.y0} : cut;
}

}  // namespace

std::uint32_t parts_across(std::uint32_t parts) {
  std::uint32_t across = 1;
  while (across * across < parts) ++across;
  return across * across == parts ? across : 0;
}

std::uint32_t part_px(std::uint32_t group_px, std::uint32_t parts) {
  const std::uint32_t across = parts_across(parts), subtiles = group_px / kSubtilePx;
  return (subtiles + across - 1) / across * kSubtilePx;
}

std::vector<std::vector<PixelRect>> group_parts(const std::vector<PixelRect>& groups,
                                                std::uint32_t group_px, std::uint32_t parts) {
  const std::uint32_t across = parts_across(parts), subtiles = group_px / kSubtilePx;
  std::vector<std::vector<PixelRect>> out(parts);
  for (std::uint32_t p = 0; p < parts; ++p) {
    for (const PixelRect& group : groups) {
      out[p].push_back(part_of(group, p % across, p / across, subtiles, across));
    }
  }
  return out;
}

}  // namespace sgs
