// Observers of a streaming renderer: what was blended where, and in what order.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "algorithm/splat/blend.h"

namespace sgs {

// Watches the sub-tiles of one group.
class BlendWatch {
 public:
  explicit BlendWatch(std::size_t subtiles) : seen_(subtiles) {}

  // To be called after each blend into sub-tile `at` of the group. Whether the splat at `depth` was
  // blended into any of its pixels.
  bool after_blend(std::size_t at, const SubtileState& state, float depth) {
    Seen& seen = seen_[at];
    bool any = false;
    for (int lane = 0; lane < kSubtilePixels; ++lane) {
      const bool blended = state.contributors[lane] != seen.contributors[lane];
      any |= blended;
      misordered_ += blended && depth < seen.deepest[lane] ? 1 : 0;
      seen.deepest[lane] = blended ? std::max(depth, seen.deepest[lane]) : seen.deepest[lane];
      seen.contributors[lane] = state.contributors[lane];
    }
    return any;
  }

  // Blends, per pixel, of a splat that is nearer than one already blended there.
  std::uint64_t misordered() const { return misordered_; }

 private:
  struct Seen {
    float deepest[kSubtilePixels] = {};
    std::int32_t contributors[kSubtilePixels] = {};
  };
  std::vector<Seen> seen_;
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
