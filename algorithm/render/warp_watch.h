// What the warps of a GPU do that blends a tile with a thread for each pixel: 16 x 2 px each, all
// in step.
#pragma once

#include <array>
#include <cstdint>

#include "algorithm/render/group_state.h"
#include "algorithm/splat/constants.h"

namespace sgs {

constexpr int kWarpsOfTile = 8, kWarpThreads = 32;

class WarpWatch {
 public:
  // pixels: of the tile, cut to the frame. What lies outside counts as finished.
  explicit WarpWatch(const PixelRect& pixels) {
    for (int y = 0; y < pixels.height(); ++y) unfinished_[row_pair(y)] += pixels.width();
    for (int y = 0; y < kTilePx; ++y) {
      for (int x = 0; x < kTilePx; ++x) {
        active_[y / kSubtilePx * kSubtilesPerTile + x / kSubtilePx][lane(x, y)] =
            x < pixels.width() && y < pixels.height() ? -1 : 0;
      }
    }
  }

  // Behind each sub-tile of an entry that is blended.
  void see(const SubtileBlend& blend) {
    const int row = blend.y % kSubtilesPerTile, column = blend.x % kSubtilesPerTile;
    auto& active = active_[static_cast<std::size_t>(row * kSubtilesPerTile + column)];
    constexpr std::size_t kLanes = kSubtilePixels / 2;  // of a warp in a sub-tile
    for (std::size_t first = 0; first < kSubtilePixels; first += kLanes) {
      std::int32_t blends = 0, left = 0;
      for (std::size_t l = first; l < first + kLanes; ++l) {
        blends |= blend.shares.alpha[l] > 0 ? -1 : 0;
        left += active[l] & ~blend.behind.active[l];  // masks: -1 where both are set
        active[l] = blend.behind.active[l];
      }
      const std::size_t warp = row_pair(row * kSubtilePx + static_cast<int>(first) / kSubtilePx);
      blends_[warp] |= blends != 0;
      left_[warp] += left;
    }
  }

  // Behind each entry: every warp with an unfinished pixel has looked at it.
  void end_entry() {
    for (std::size_t w = 0; w < kWarpsOfTile; ++w) {
      entries_ += unfinished_[w] > 0 ? 1 : 0;
      blended_ += blends_[w] ? 1 : 0;
      unfinished_[w] += left_[w];
      left_[w] = 0;
      blends_[w] = false;
    }
  }

  std::uint64_t entries() const { return entries_; }  // that a warp looked at
  std::uint64_t blended() const { return blended_; }  // of these into one pixel at least

 private:
  static std::size_t row_pair(int y) { return static_cast<std::size_t>(y) / 2; }
  static std::size_t lane(int x, int y) {
    return static_cast<std::size_t>(y % kSubtilePx * kSubtilePx + x % kSubtilePx);
  }

  // Masks: -1 of a pixel that was active behind the last entry, as in SubtileState.
  std::array<std::array<std::int32_t, kSubtilePixels>, kSubtilesPerTile * kSubtilesPerTile>
      active_{};
  std::array<int, kWarpsOfTile> unfinished_{}, left_{};
  std::array<bool, kWarpsOfTile> blends_{};
  std::uint64_t entries_ = 0, blended_ = 0;
};

}  // namespace sgs
