// Blending into the sub-tiles of a group.
#include "algorithm/render/group_state.h"

#include <algorithm>

#include "algorithm/splat/blend.h"
#include "algorithm/splat/group_numbers.h"

namespace sgs {

GroupState::GroupState(const PixelRect& pixels, int width_px, int height_px,
                       BlendPrecision precision, SubtileTest test)
    : pixels_(pixels), precision_(precision), test_(test) {
  const auto down = [](int px) { return static_cast<std::uint16_t>(px / kSubtilePx); };
  subtiles_ = {down(pixels.x0), down(pixels.y0), down(pixels.x1 + kSubtilePx - 1),
               down(pixels.y1 + kSubtilePx - 1)};
  states_.reserve(static_cast<std::size_t>(subtiles_.x1 - subtiles_.x0) *
                  static_cast<std::size_t>(subtiles_.y1 - subtiles_.y0));
  for (int y = subtiles_.y0; y < subtiles_.y1; ++y) {
    for (int x = subtiles_.x0; x < subtiles_.x1; ++x) {
      states_.push_back(make_subtile(x, y, width_px, height_px));
    }
  }
  finished_.assign(states_.size(), 0);
  unfinished_ = static_cast<std::uint32_t>(states_.size());
}

bool GroupState::any_unfinished(const GroupReach& reach) const {
  const int columns = subtiles_.x1 - subtiles_.x0, rows = subtiles_.y1 - subtiles_.y0;
  for (int y = reach.y0; y <= std::min<int>(reach.y1, rows - 1); ++y) {
    const auto row = finished_.begin() + static_cast<std::ptrdiff_t>(y) * columns;
    const int end = std::min<int>(reach.x1 + 1, columns);
    if (std::find(row + std::min<int>(reach.x0, end), row + end, 0) != row + end) return true;
  }
  return false;
}

const SubtileState& GroupState::subtile_of(int x, int y, int& lane) const {
  lane = (y % kSubtilePx) * kSubtilePx + x % kSubtilePx;
  const int columns = subtiles_.x1 - subtiles_.x0;
  return states_[static_cast<std::size_t>((y / kSubtilePx - subtiles_.y0) * columns +
                                          (x / kSubtilePx - subtiles_.x0))];
}

glm::vec3 GroupState::colour(int x, int y, const glm::vec3& background) const {
  int lane = 0;
  const SubtileState& s = subtile_of(x, y, lane);
  const float t = s.transmittance[lane];
  return {over_background(s.red[lane], t, background.x),
          over_background(s.green[lane], t, background.y),
          over_background(s.blue[lane], t, background.z)};
}

std::uint64_t GroupState::contributors() const {
  std::uint64_t sum = 0;
  for (const SubtileState& s : states_) {
    for (const std::int32_t count : s.contributors) sum += static_cast<std::uint64_t>(count);
  }
  return sum;
}

std::uint64_t GroupState::finished_pixels() const {
  std::uint64_t sum = 0;
  for (int y = pixels_.y0; y < pixels_.y1; ++y) {
    for (int x = pixels_.x0; x < pixels_.x1; ++x) {
      int lane = 0;
      sum += subtile_of(x, y, lane).active[lane] == 0 ? 1 : 0;
    }
  }
  return sum;
}

void GroupState::store(const glm::vec3& background, RenderResult& frame) const {
  for (int y = pixels_.y0; y < pixels_.y1; ++y) {
    for (int x = pixels_.x0; x < pixels_.x1; ++x) {
      int lane = 0;
      const SubtileState& s = subtile_of(x, y, lane);
      const auto at = static_cast<std::size_t>(y) * frame.image.width + x;
      frame.image.pixels[at] = colour(x, y, background);
      frame.transmittance[at] = s.transmittance[lane];
      frame.contributors[at] = static_cast<std::uint32_t>(s.contributors[lane]);
    }
  }
}

std::vector<PixelRect> pixel_groups(int width_px, int height_px, const PixelSize& group) {
  const PixelSize frame{width_px, height_px};
  std::vector<PixelRect> groups;
  for (GroupPlaceOf<int> at; at.y < height_px; at = group_behind(at, group, frame)) {
    groups.push_back(group_at(at, group, frame));
  }
  return groups;
}

}  // namespace sgs
