// Observers of a streaming renderer: what was blended where, and in what order.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "algorithm/render/group_state.h"
#include "algorithm/splat/constants.h"

namespace sgs {

// Watches the sub-tiles of one group.
class BlendWatch {
 public:
  explicit BlendWatch(std::size_t subtiles) : deepest_(subtiles) {}

  // To be called with each blend into the group. Returns true if the splat at `depth` was blended
  // into any of the sub-tile's pixels.
  bool see(const SubtileBlend& blend, float depth) {
    // Masks and numbers of 32 bits, so that a loop over lanes is vector code.
    Deepest& deepest = deepest_[blend.at];
    std::int32_t any = 0, behind = 0;
    for (int lane = 0; lane < kSubtilePixels; ++lane) {
      const std::int32_t blended = blend.shares.alpha[lane] > 0 ? -1 : 0;
      any |= blended;
      behind -= blended & (depth < deepest.depth[lane] ? -1 : 0);
      const float deeper = std::max(depth, deepest.depth[lane]);
      deepest.depth[lane] = blended != 0 ? deeper : deepest.depth[lane];
    }
    misordered_ += static_cast<std::uint32_t>(behind);
    return any != 0;
  }

  // Blends, per pixel, of a splat that is nearer than one already blended there.
  std::uint64_t misordered() const { return misordered_; }

 private:
  struct Deepest {
    float depth[kSubtilePixels] = {};  // greatest depth blended there
  };
  std::vector<Deepest> deepest_;
  std::uint64_t misordered_ = 0;
};

// One flag for each of many things, set from any thread.
class Flags {
 public:
  explicit Flags(std::size_t count) : flags_(count) {}
  void set(std::size_t index) { flags_[index].store(1, std::memory_order_relaxed); }
  std::uint64_t count() const {
    return static_cast<std::uint64_t>(std::count_if(
        flags_.begin(), flags_.end(), [](const auto& flag) { return flag.load() != 0; }));
  }

 private:
  std::vector<std::atomic<std::uint8_t>> flags_;
};

// The warps of a GPU that blends a tile with a thread for each pixel: 16 x 2 px each, all in step.
constexpr int kWarpsOfTile = 8;

class WarpWatch {
 public:
  // pixels: of the tile, cut to the frame. Pixels outside count as finished.
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
    constexpr std::size_t kLanes = kSubtilePixels / 2;  // lanes of a warp in a sub-tile
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

  std::uint64_t entries() const { return entries_; }  // (entry, warp) pairs that were looked at
  std::uint64_t blended() const { return blended_; }  // pairs among these that blend into a pixel

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
