// The pixels of one group while it is being blended, as the rendering unit holds them.
#pragma once

#include <cstdint>
#include <vector>

#include "algorithm/render/render_result.h"
#include "algorithm/splat/blend.h"
#include "algorithm/splat/footprint.h"
#include "algorithm/splat/rects.h"

namespace sgs {

// Which 4x4 sub-tiles of a splat's footprint are blended: all, or only those that its visible
// ellipse can reach. The pixels are the same; the test costs less than the blending it spares.
enum class SubtileTest { kBox, kEllipse };

struct BlendWork {
  std::uint32_t tested = 0;   // sub-tiles of the footprint put to the ellipse test
  std::uint32_t blended = 0;  // sub-tiles blended
};

// One splat in one sub-tile, as an observer of blending sees it.
struct SubtileBlend {
  std::size_t at;              // the sub-tile's place in the group
  int x, y;                    // the sub-tile, in the whole frame
  const LaneShares& shares;    // alpha and T in front of the splat
  const SubtileState& behind;  // the pixels with the splat in them
};

class GroupState {
 public:
  // pixels: corner on a multiple of 4 px, cut to the frame of width x height px.
  GroupState(const PixelRect& pixels, int width_px, int height_px,
             SubtileTest test = SubtileTest::kEllipse);

  // Blends a splat into the unfinished 4x4 sub-tiles of its footprint that it reaches.
  BlendWork blend(const Splat& splat) {
    return for_reached(splat,
                       [&](std::size_t at, int x, int y) { sgs::blend(states_[at], x, y, splat); });
  }
  // The same, observed: observer(SubtileBlend) is called behind each.
  template <class Observer>
  BlendWork blend(const Splat& splat, Observer&& observer) {
    return for_reached(splat, [&](std::size_t at, int x, int y) {
      const LaneShares shares = blend_and_tell(states_[at], x, y, splat);
      observer(SubtileBlend{at, x, y, shares, states_[at]});
    });
  }
  std::size_t subtile_count() const { return states_.size(); }

  // All pixels finished (T would fall below 1e-4): nothing can change any more.
  bool saturated() const { return unfinished_ == 0; }
  const PixelRect& pixels() const { return pixels_; }
  glm::vec3 colour(int x, int y, const glm::vec3& background) const;  // C + T background
  std::uint64_t contributors() const;

  // Copies the group into a whole frame.
  void store(const glm::vec3& background, RenderResult& frame) const;

 private:
  // A splat on so few sub-tiles is blended in one cycle anyway.
  static constexpr int kUntestedSubtiles = 4;

  // blend_into(place in the group, x, y) for each unfinished sub-tile that the splat reaches.
  template <class BlendInto>
  BlendWork for_reached(const Splat& splat, const BlendInto& blend_into) {
    const SubtileRect reach = intersection(splat.footprint, subtiles_);
    const int columns = subtiles_.x1 - subtiles_.x0;
    const int count = (reach.x1 - reach.x0) * (reach.y1 - reach.y0);
    const bool test = test_ == SubtileTest::kEllipse && count > kUntestedSubtiles;
    const float cutoff = test ? visible_cutoff(splat.opacity) : 0;
    BlendWork work;
    for (int y = reach.y0; y < reach.y1; ++y) {
      for (int x = reach.x0; x < reach.x1; ++x) {
        const auto at = static_cast<std::size_t>((y - subtiles_.y0) * columns + (x - subtiles_.x0));
        if (finished_[at] != 0) continue;
        work.tested += test ? 1 : 0;
        if (test && !reaches_subtile(splat, cutoff, x, y)) continue;
        blend_into(at, x, y);
        ++work.blended;
        if (finished(states_[at])) {
          finished_[at] = 1;
          --unfinished_;
        }
      }
    }
    return work;
  }
  static bool reaches_subtile(const Splat& s, float cutoff, int x, int y) {
    const PixelRect pixels{x * kSubtilePx, y * kSubtilePx, (x + 1) * kSubtilePx,
                           (y + 1) * kSubtilePx};
    return reaches(s.x, s.y, s.conic_a, s.conic_b, s.conic_c, cutoff, pixels);
  }
  const SubtileState& subtile_of(int x, int y, int& lane) const;

  PixelRect pixels_;
  SubtileTest test_;
  SubtileRect subtiles_;
  std::vector<SubtileState> states_;  // [rows, columns] of sub-tiles
  std::vector<std::uint8_t> finished_;
  std::uint32_t unfinished_ = 0;
};

// Groups of a frame, row by row; the last column and row are cut to the frame.
std::vector<PixelRect> pixel_groups(int width_px, int height_px, int group_px);

}  // namespace sgs
