// Where the parts of a group lie.
#include "algorithm/render/group_parts.h"

#include "algorithm/splat/constants.h"

namespace sgs {
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
