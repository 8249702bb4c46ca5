// The pixels of one group while it is being blended (equation 3 of Kerbl et al. 2023), as the
// rendering unit holds them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "algorithm/render/render_result.h"
#include "algorithm/splat/blend.h"
#include "algorithm/splat/extent_bound.h"
#include "algorithm/splat/footprint.h"
#include "algorithm/splat/rects.h"
#include "algorithm/splat/row_span.h"
#include "algorithm/splat/square_conic.h"

namespace sgs {

// The 4x4 sub-tiles of a splat's footprint that are blended: all, or only those that its visible
// ellipse can reach, row by row (row_span.h). The pixels are the same; the spans cost less than the
// blending they spare.
enum class SubtileTest { kBox, kEllipse };

struct BlendWork {
  std::uint32_t rows = 0;     // rows of sub-tiles in the footprint
  std::uint32_t spans = 0;    // rows among these whose span was computed: all or none
  std::uint32_t blended = 0;  // sub-tiles blended
};

// One splat in one sub-tile, as an observer of blending sees it.
struct SubtileBlend {
  std::size_t at;              // the sub-tile's place in the group
  int x, y;                    // the sub-tile, in the whole frame
  const LaneShares& shares;    // alpha and T in front of the splat
  const SubtileState& behind;  // the pixels with the splat in them
};

// A sub-tile that a splat reaches, as whoever schedules the blending sees it.
struct SubtileReach {
  std::size_t at;     // the sub-tile's place in the group
  int x, y;           // the sub-tile, in the whole frame
  bool blends;        // it was unfinished; a finished one does not change
  bool finishes;      // with this splat
  std::uint32_t row;  // row of the splat, from 0 on
};

// The part of a group that a splat may reach, before its rows have spans.
struct SplatBox {
  SubtileRect subtiles;  // the footprint's, from the group's corner on
  bool spanned;          // its rows get spans
};

class GroupState {
 public:
  // pixels: corner on a multiple of 4 px, cut to the frame of width x height px.
  GroupState(const PixelRect& pixels, int width_px, int height_px,
             BlendPrecision precision = BlendPrecision::kSingle,
             SubtileTest test = SubtileTest::kEllipse);

  // Blends a splat into the unfinished 4x4 sub-tiles of its footprint that it reaches. AnySplat: a
  // Splat; or a SquareSplat in a group in 16 bits without SubtileTest::kEllipse, which asks for
  // terms.
  template <class AnySplat>
  BlendWork blend(const AnySplat& splat) {
    return for_reached(splat, [&](const auto& taken, std::size_t at, int x, int y, std::uint32_t) {
      if (finished_[at] != 0) return false;
      sgs::blend(states_[at], x, y, taken);
      return true;
    });
  }
  // The same, observed: observer(SubtileBlend) is called behind each.
  template <class AnySplat, class Observer>
  BlendWork blend(const AnySplat& splat, Observer&& observer) {
    return for_reached(splat, [&](const auto& taken, std::size_t at, int x, int y, std::uint32_t) {
      if (finished_[at] != 0) return false;
      const LaneShares shares = blend_and_tell(states_[at], x, y, taken);
      observer(SubtileBlend{at, x, y, shares, states_[at]});
      return true;
    });
  }
  // The same, told of every sub-tile that is reached, row by row: schedule(SubtileReach).
  template <class Schedule>
  BlendWork blend_scheduled(const Splat& splat, Schedule&& schedule) {
    const auto into = [&](const auto& taken, std::size_t at, int x, int y, std::uint32_t row) {
      const bool blends = finished_[at] == 0;
      if (blends) sgs::blend(states_[at], x, y, taken);
      schedule(SubtileReach{at, x, y, blends, blends && finished(states_[at]), row});
      return blends;
    };
    return for_reached(splat, into);
  }
  SplatBox box_of(const Splat& splat) const {
    const SubtileRect reach = intersection(splat.footprint, subtiles_);
    if (reach.empty()) return {};
    const auto from = [](int at, int corner) { return static_cast<std::uint16_t>(at - corner); };
    return {{from(reach.x0, subtiles_.x0), from(reach.y0, subtiles_.y0),
             from(reach.x1, subtiles_.x0), from(reach.y1, subtiles_.y0)},
            spanned(reach)};
  }
  std::size_t subtile_count() const { return states_.size(); }
  std::size_t subtile_columns() const {
    return static_cast<std::size_t>(subtiles_.x1 - subtiles_.x0);
  }

  // All pixels finished (T would fall below 1e-4): nothing can change any more.
  bool saturated() const { return unfinished_ == 0; }
  // Some sub-tile of the reach is not.
  bool any_unfinished(const GroupReach& reach) const;
  const PixelRect& pixels() const { return pixels_; }
  glm::vec3 colour(int x, int y, const glm::vec3& background) const;  // C + T background
  std::uint64_t contributors() const;
  std::uint64_t finished_pixels() const;  // of the frame

  // Copies the group into a whole frame.
  void store(const glm::vec3& background, RenderResult& frame) const;

 private:
  // A splat on so few sub-tiles costs hardly more to blend than its rows do.
  static constexpr int kUntestedSubtiles = 4;

  // Where row spans cost less than the sub-tiles that they spare.
  bool spanned(const SubtileRect& reach) const {
    return test_ == SubtileTest::kEllipse &&
           (reach.x1 - reach.x0) * (reach.y1 - reach.y0) > kUntestedSubtiles;
  }
  // blend_into(the splat as it is blended, place in the group, x, y, row of the splat) for each
  // sub-tile that the splat reaches, row by row; it says whether it has blended.
  template <class BlendInto>
  BlendWork for_reached(const Splat& splat, const BlendInto& blend_into) {
    switch (precision_) {
      case BlendPrecision::kHalf:
        return for_rows(splat, of_taken(square_splat(splat), blend_into));
      case BlendPrecision::kFixed:
        return for_rows(splat, of_taken(SplatOnFixedPixels{square_splat(splat)}, blend_into));
      case BlendPrecision::kSingle:
        break;
    }
    return for_rows(splat, of_taken(splat, blend_into));
  }
  template <class BlendInto>
  BlendWork for_reached(const SquareSplat& splat, const BlendInto& blend_into) {
    const SubtileRect reach = intersection(splat.footprint, subtiles_);
    BlendWork work;
    if (reach.empty()) return work;
    if (precision_ == BlendPrecision::kFixed) {
      box_rows(reach, of_taken(SplatOnFixedPixels{splat}, blend_into), work);
    } else {
      box_rows(reach, of_taken(splat, blend_into), work);
    }
    return work;
  }
  template <class Taken, class BlendInto>
  static auto of_taken(const Taken& taken, const BlendInto& blend_into) {
    return [taken, &blend_into](std::size_t at, int x, int y, std::uint32_t row) {
      return blend_into(taken, at, x, y, row);
    };
  }
  template <class BlendInto>
  void box_rows(const SubtileRect& reach, const BlendInto& blend_into, BlendWork& work) {
    for (int y = reach.y0; y < reach.y1; ++y) blend_row(y, reach.x0, reach.x1, blend_into, work);
  }
  template <class BlendInto>
  BlendWork for_rows(const Splat& splat, const BlendInto& blend_into) {
    const SubtileRect reach = intersection(splat.footprint, subtiles_);
    BlendWork work;
    if (reach.empty()) return work;
    if (!spanned(reach)) {
      box_rows(reach, blend_into, work);
      return work;
    }
    RowSpans<float> spans(splat);
    spans.start(reach.y0 * kSubtilePx);
    for (int y = reach.y0; y < reach.y1; ++y) {
      const RowBounds<float> bounds = spans.next(y * kSubtilePx, (y + 1) * kSubtilePx);
      ++work.spans;
      blend_row(y, std::max<int>(reach.x0, subtile_at(std::ceil(bounds.low))),
                std::min<int>(reach.x1, subtile_at(bounds.high) + 1), blend_into, work);
    }
    return work;
  }
  template <class BlendInto>
  void blend_row(int y, int x0, int x1, const BlendInto& blend_into, BlendWork& work) {
    const int columns = subtiles_.x1 - subtiles_.x0;
    for (int x = x0; x < x1; ++x) {
      const auto at = static_cast<std::size_t>((y - subtiles_.y0) * columns + (x - subtiles_.x0));
      if (!blend_into(at, x, y, work.rows)) continue;
      ++work.blended;
      if (finished(states_[at])) {
        finished_[at] = 1;
        --unfinished_;
      }
    }
    ++work.rows;
  }
  // The sub-tile column of the last pixel centre at or before x_px; -1 left of the frame.
  static int subtile_at(float x_px) {
    constexpr auto kRightOfAll = static_cast<float>(kMaxFramePx);
    if (!(x_px >= 0)) return -1;
    return static_cast<int>(std::min(x_px, kRightOfAll)) / kSubtilePx;
  }
  const SubtileState& subtile_of(int x, int y, int& lane) const;

  PixelRect pixels_;
  BlendPrecision precision_;
  SubtileTest test_;
  SubtileRect subtiles_;
  std::vector<SubtileState> states_;  // [rows, columns] of sub-tiles
  std::vector<std::uint8_t> finished_;
  std::uint32_t unfinished_ = 0;
};

// Groups of a frame, row by row; the last column and row are cut to the frame.
std::vector<PixelRect> pixel_groups(int width_px, int height_px, const PixelSize& group);

}  // namespace sgs
