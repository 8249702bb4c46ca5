// Blending and storing of one tile.
#include "algorithm/render/tile_state.h"

#include <algorithm>

#include "algorithm/splat/footprint.h"

namespace sgs {

TileState::TileState(int tile_x, int tile_y, int width_px, int height_px)
    : subtile_x0_(tile_x * kSubtilesPerTile), subtile_y0_(tile_y * kSubtilesPerTile) {
  for (int k = 0; k < kSubtilesPerTile * kSubtilesPerTile; ++k) {
    subtiles_[k] = make_subtile(subtile_x0_ + k % kSubtilesPerTile,
                                subtile_y0_ + k / kSubtilesPerTile, width_px, height_px);
    open_ |= 1U << k;
  }
  close_finished();
}

void TileState::close_finished() {
  for (int k = 0; k < kSubtilesPerTile * kSubtilesPerTile; ++k) {
    if ((open_ >> k & 1U) != 0 && sgs::finished(subtiles_[k])) open_ &= ~(1U << k);
  }
}

void TileState::blend(const Splat* splats, const std::uint32_t* begin, const std::uint32_t* end) {
  // Looking for finished sub-tiles costs about as much as one blend into each.
  constexpr int kCheckEvery = 16;
  if (open_ == 0) return;
  int until_check = kCheckEvery;
  for (const std::uint32_t* entry = begin; entry != end; ++entry) {
    const Splat& splat = splats[*entry];
    const int x0 = std::max(splat.footprint.x0 - subtile_x0_, 0);
    const int x1 = std::min(splat.footprint.x1 - subtile_x0_, kSubtilesPerTile);
    const int y0 = std::max(splat.footprint.y0 - subtile_y0_, 0);
    const int y1 = std::min(splat.footprint.y1 - subtile_y0_, kSubtilesPerTile);
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) {
        const int k = y * kSubtilesPerTile + x;
        if ((open_ >> k & 1U) == 0) continue;
        sgs::blend(subtiles_[k], subtile_x0_ + x, subtile_y0_ + y, splat);
      }
    }
    if (--until_check == 0) {
      close_finished();
      if (open_ == 0) return;
      until_check = kCheckEvery;
    }
  }
}

void TileState::store(const glm::vec3& background, RenderResult& frame) const {
  const int x0 = subtile_x0_ * kSubtilePx, y0 = subtile_y0_ * kSubtilePx;
  const int width = std::min(kTilePx, frame.image.width - x0);
  const int height = std::min(kTilePx, frame.image.height - y0);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const SubtileState& s = subtiles_[y / kSubtilePx * kSubtilesPerTile + x / kSubtilePx];
      const int lane = y % kSubtilePx * kSubtilePx + x % kSubtilePx;
      const float t = s.transmittance[lane];
      const auto at = static_cast<std::size_t>(y0 + y) * frame.image.width + (x0 + x);
      frame.image.pixels[at] = {s.red[lane] + t * background.x, s.green[lane] + t * background.y,
                                s.blue[lane] + t * background.z};
      frame.transmittance[at] = t;
      frame.contributors[at] = static_cast<std::uint32_t>(s.contributors[lane]);
    }
  }
}

}  // namespace sgs
