// Observers of a streaming renderer: what was blended where, and in what order.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "algorithm/render/group_state.h"

namespace sgs {

// Watches the sub-tiles of one group.
class BlendWatch {
 public:
  explicit BlendWatch(std::size_t subtiles) : deepest_(subtiles) {}

  // To be called with each blend into the group. Whether the splat at `depth` was blended into any
  // of the sub-tile's pixels.
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
    float depth[kSubtilePixels] = {};  // of what is blended there
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

}  // namespace sgs
