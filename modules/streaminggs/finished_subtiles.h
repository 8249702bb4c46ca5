// Rendering's mask of finished sub-tiles: nothing changes them any more. The news of each travels
// as that of finished groups does (finished_groups.h) and may be late: then something is fetched
// that changes nothing.
// Hardware keeps one mask, of the group that is being blended: rendering takes the groups in turn,
// and of a later one nothing is finished yet.
#pragma once

#include <algorithm>
#include <cstdint>
#include <systemc>
#include <vector>

#include "algorithm/splat/constants.h"
#include "algorithm/splat/extent_bound.h"
#include "algorithm/splat/rects.h"
#include "modules/streaminggs/built_for.h"
#include "tlm/clock_domain.h"
#include "tlm/sram_use.h"

namespace sgs {

class FinishedSubtilesIf : public virtual sc_core::sc_interface {
 public:
  // True if any sub-tile of `reach` is not known to be finished.
  virtual bool any_unfinished(std::uint32_t group, const GroupReach& reach) const = 0;
  // Sub-tiles of which the news was sent.
  virtual std::uint64_t news() const = 0;
};

class FinishSubtileIf : public virtual sc_core::sc_interface {
 public:
  // at: the sub-tile's place in the group, row by row; known_in_cycles: as with finished groups.
  virtual void finish(std::uint32_t group, std::size_t at, std::uint32_t known_in_cycles) = 0;
};

class FinishedSubtiles : public sc_core::sc_prim_channel,
                         public FinishedSubtilesIf,
                         public FinishSubtileIf {
 public:
  // latency_cycles: at least 1, so that what units see does not depend on which of them the kernel
  // runs first.
  FinishedSubtiles(const char* name, const ClockDomain& clock, const std::vector<PixelRect>& groups,
                   std::uint32_t latency_cycles)
      : sc_prim_channel(name),
        period_(clock.period()),
        latency_cycles_(latency_cycles),
        masks_(groups.size()) {
    for (std::size_t g = 0; g < groups.size(); ++g) {
      masks_[g].columns = (groups[g].width() + kSubtilePx - 1) / kSubtilePx;
      masks_[g].rows = (groups[g].height() + kSubtilePx - 1) / kSubtilePx;
    }
  }

  void finish(std::uint32_t group, std::size_t at, std::uint32_t known_in_cycles) override {
    Mask& mask = masks_[group];
    if (mask.seen_from.empty()) {
      mask.seen_from.assign(static_cast<std::size_t>(mask.columns) * mask.rows,
                            sc_core::sc_max_time());
    }
    const double cycles = static_cast<double>(known_in_cycles) + latency_cycles_;
    mask.seen_from[at] = sc_core::sc_time_stamp() + cycles * period_;
    ++news_;
  }
  bool any_unfinished(std::uint32_t group, const GroupReach& reach) const override {
    const Mask& mask = masks_[group];
    if (mask.seen_from.empty()) return true;
    const sc_core::sc_time now = sc_core::sc_time_stamp();
    for (int y = reach.y0; y <= std::min<int>(reach.y1, mask.rows - 1); ++y) {
      for (int x = reach.x0; x <= std::min<int>(reach.x1, mask.columns - 1); ++x) {
        if (mask.seen_from[static_cast<std::size_t>(y) * mask.columns + x] > now) return true;
      }
    }
    return false;
  }
  std::uint64_t news() const override { return news_; }

  const char* kind() const override { return "sgs::FinishedSubtiles"; }

 private:
  struct Mask {
    int columns = 0, rows = 0;
    std::vector<sc_core::sc_time> seen_from;  // [row, column]; empty: nothing is finished
  };

  const sc_core::sc_time period_;
  const std::uint32_t latency_cycles_;
  std::vector<Mask> masks_;  // [group]
  std::uint64_t news_ = 0;
};

// One an eye.
using FinishedSubtilesIns = sc_core::sc_port<FinishedSubtilesIf, 0>;
// Not bound where nobody asks.
using FinishSubtileOut = sc_core::sc_port<FinishSubtileIf, 1, sc_core::SC_ZERO_OR_MORE_BOUND>;

// The eyes for which some sub-tile of `reach` is not known to be finished, a bit each.
inline std::uint32_t unfinished_eyes(FinishedSubtilesIns& masks, std::uint32_t group,
                                     const GroupReach& reach) {
  std::uint32_t eyes = 0;
  for (int e = 0; e < masks.size(); ++e) {
    eyes |= masks[e]->any_unfinished(group, reach) ? 1U << e : 0U;
  }
  return eyes;
}
inline std::uint64_t news(FinishedSubtilesIns& masks) {
  std::uint64_t sum = 0;
  for (int e = 0; e < masks.size(); ++e) sum += masks[e]->news();
  return sum;
}

// A bit a sub-tile, in registers: all are read at once, and cleared; each cluster may finish one in
// a cycle. Each unit that asks keeps its own.
inline SramUse mask_use(const PixelSize& group) {
  const auto columns = static_cast<std::uint32_t>(group.width / kSubtilePx);
  const auto rows = static_cast<std::uint32_t>(group.height / kSubtilePx);
  const std::uint32_t row_bytes = (columns + 7) / 8;
  const std::uint32_t bits = 8 * rows * row_bytes;
  return sram_use("finished sub-tiles", kSharedSram, {{rows, "rows"}, {row_bytes, "B"}},
                  {1, SramPorts::kReadAndWrite, bits}, {bits, bits});
}
// Bits that a look-up reads.
inline std::uint64_t mask_bits(const PixelSize& group) { return mask_use(group).shape.banks; }
// Comparators of a look-up: it selects the columns of a reach in each row, and tests whether one of
// them is unfinished. That costs about as much as a comparison of 32 bits.
inline std::uint32_t mask_comparators(const PixelSize& group) {
  const auto columns = static_cast<std::uint32_t>(group.width / kSubtilePx);
  const auto rows = static_cast<std::uint32_t>(group.height / kSubtilePx);
  return rows * ((columns + 31) / 32);
}

}  // namespace sgs
