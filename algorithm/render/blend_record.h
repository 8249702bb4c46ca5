// The splats of one group as its clusters will meet them: what a schedule of the blending follows
// from, without a pixel.
#pragma once

#include <cstdint>
#include <vector>

#include "algorithm/render/group_state.h"

namespace sgs {

// Sub-tiles [x0, x1) of the frame that a splat reaches in one row; may be none.
struct BlendRow {
  std::uint16_t x0 = 0, x1 = 0;
};

struct BlendedSplat {
  SplatBox box;
  std::uint32_t first_row = 0, first_finish = 0;  // in the group's
  std::uint16_t rows = 0, spans = 0;              // of sub-tiles; rows whose span was computed
  std::uint16_t finishes = 0;                     // sub-tiles that are finished with it
};

// Of one group, in the order of blending.
class BlendRecord {
 public:
  // The next splat.
  void begin(const SplatBox& box) {
    splats_.push_back({box, static_cast<std::uint32_t>(rows_.size()),
                       static_cast<std::uint32_t>(finishes_.size())});
  }
  void reach(const SubtileReach& subtile) {
    BlendedSplat& splat = splats_.back();
    rows_.resize(splat.first_row + subtile.row + 1U);
    BlendRow& row = rows_.back();
    const auto x = static_cast<std::uint16_t>(subtile.x);
    if (row.x1 == 0) row.x0 = x;
    row.x1 = static_cast<std::uint16_t>(x + 1);
    if (!subtile.finishes) return;
    finishes_.push_back(static_cast<std::uint32_t>(subtile.at));
    ++splat.finishes;
  }
  void end(const BlendWork& work) {
    BlendedSplat& splat = splats_.back();
    splat.rows = static_cast<std::uint16_t>(work.rows);
    splat.spans = static_cast<std::uint16_t>(work.spans);
    rows_.resize(splat.first_row + work.rows);
  }

  const std::vector<BlendedSplat>& splats() const { return splats_; }
  const BlendRow* rows_of(const BlendedSplat& splat) const { return &rows_[splat.first_row]; }
  const std::uint32_t* finishes_of(const BlendedSplat& splat) const {
    return finishes_.data() + splat.first_finish;
  }
  std::size_t size_bytes() const {
    return splats_.capacity() * sizeof splats_[0] + rows_.capacity() * sizeof rows_[0] +
           finishes_.capacity() * sizeof finishes_[0];
  }

 private:
  std::vector<BlendedSplat> splats_;
  std::vector<BlendRow> rows_;
  std::vector<std::uint32_t> finishes_;  // their places in the group
};

}  // namespace sgs
