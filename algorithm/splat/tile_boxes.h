// Which 16x16 tiles a splat is listed in, and which parts of such a tile it may touch: what a
// tile-centric machine decides when it projects a Gaussian.
#pragma once

#include <cstdint>

#include "algorithm/splat/footprint.h"
#include "algorithm/splat/make_splat.h"

namespace sgs {

// The box around a splat's ellipse along its own axes, and whether it touches a square of pixels:
// separating axes, those of the box and those of the screen.
//
// Covariance [a b; b c], lean = (a - c)/2, lambda = mid + sqrt(lean^2 + b^2): the long axis lies
// along (lean + root, b) or (b, root - lean), whichever sum does not cancel. Half sides are
// sqrt(q lambda) and sqrt(q det / lambda) for the ellipse d^T conic d <= q.
//
// Rounding. footprint.h: an ellipse wider by 64 eps kappa holds every pixel that is computed as
// visible, kappa = tr^2 / det; the determinant is off by (6 + 4 sqrt(kappa)) eps, below 10^-4 while
// that widening is below 1/2. The box is only used where the axes' ratio is above 2: the axis is
// then off by at most 12 eps (b by 3 eps |u1| |u2|, over lambda - lambda' >= 3/4 lambda), which at
// the ends of the box and 40 px beyond is less than 10^-6 of the long side and 10^-4 px. Factors of
// 1.0002, 0.02 px for places on the screen (as footprint.h) and 2 10^-5 of the long side hold all.
constexpr float kOrientedRatio = 2.0F;  // least axis ratio: below, such a box spares hardly a tile

template <class T>
struct OrientedBox {
  bool used = false;            // the ellipse is long enough, and not too long for its rounding
  T x{}, y{};                   // px, centre
  T axis_x{}, axis_y{};         // direction of the long side, unit length
  T half_long{}, half_short{};  // px
};

// Around the ellipse d^T conic d <= reach.
template <class T>
OrientedBox<T> oriented_box(const Projected<T>& p, T reach) {
  OrientedBox<T> box;
  const T half = T(0.5F);
  const T trace = T(p.cov_a + p.cov_c), lean = T(half * T(p.cov_a - p.cov_c));
  const T root = sqrt_of(T(lean * lean + p.cov_b * p.cov_b));
  const T lambda = T(half * trace + root);
  const T widening = ellipse_widening(T(trace * trace / p.determinant));
  const T other = T(p.determinant / lambda);
  box.used = lambda > T(T(kOrientedRatio * kOrientedRatio) * other) && widening < T(kMaxWidening);
  if (!box.used) return box;
  box.x = p.x;
  box.y = p.y;
  const bool wide = lean > T(0.0F);
  const T along_x = wide ? T(lean + root) : p.cov_b, along_y = wide ? p.cov_b : T(root - lean);
  const T per_length = T(T(1.0F) / sqrt_of(T(along_x * along_x + along_y * along_y)));
  box.axis_x = T(along_x * per_length);
  box.axis_y = T(along_y * per_length);
  const T q = T(reach * T(T(1.0F) + widening));
  const T side = T(sqrt_of(T(q * lambda)) * T(1.0002F));
  const T slack_px = T(T(0.02F) + T(2e-5F) * side);
  box.half_long = T(side + slack_px);
  box.half_short = T(sqrt_of(T(q * other)) * T(1.0002F) + slack_px);
  return box;
}

// Limits for squares of one size: half their side, from the first pixel centre to the last, and the
// box's, along the axes of the screen and of the box.
template <class T>
struct BoxLimits {
  T screen_x, screen_y, along, across;  // px
};
template <class T>
BoxLimits<T> box_limits(const OrientedBox<T>& box, int side_px) {
  using std::abs;
  const T half = T(0.5F * static_cast<float>(side_px - 1));
  const T ex = T(abs(box.axis_x)), ey = T(abs(box.axis_y));
  const T turned = T(half * T(ex + ey));
  return {T(T(box.half_long * ex + box.half_short * ey) + half),
          T(T(box.half_long * ey + box.half_short * ex) + half), T(box.half_long + turned),
          T(box.half_short + turned)};
}

// A square's middle from the centre of the box: px along the screen and along the box.
template <class T>
struct BoxOffset {
  T x, y, along, across;
};
template <class T>
BoxOffset<T> box_offset(const OrientedBox<T>& box, IndexOf<T> x0, IndexOf<T> y0, int side_px) {
  const T half = T(0.5F * static_cast<float>(side_px - 1));
  const T dx = T(T(number_of<T>(x0) + half) - box.x), dy = T(T(number_of<T>(y0) + half) - box.y);
  return {dx, dy, T(dx * box.axis_x + dy * box.axis_y), T(dy * box.axis_x - dx * box.axis_y)};
}

// Negated, so that what is no number touches.
template <class T>
bool touches(const BoxLimits<T>& limits, const BoxOffset<T>& offset) {
  using std::abs;
  return !(T(abs(offset.x)) > limits.screen_x || T(abs(offset.y)) > limits.screen_y ||
           T(abs(offset.along)) > limits.along || T(abs(offset.across)) > limits.across);
}

// How far a splat's boxes reach: to 3 sigma, as published, or to where alpha falls below 1/255. A
// tile is in either case one of those that the reference picks, by the square of 3 sigma.
enum class TileReach : std::uint8_t { kThreeSigma, kVisible };
// By which box tiles and their parts are tested: along the screen; or along the ellipse's axes too,
// where it is long and touches more than one tile.
enum class TileTest : std::uint8_t { kBox, kOriented };

struct TileRules {
  TileReach reach = TileReach::kThreeSigma;
  TileTest test = TileTest::kOriented;
  int subtiles_across = 2;  // parts of a tile with a bit each, 1, 2 or 4 in a row; 1: the tile
};

constexpr int part_px(const TileRules& rules) { return kTilePx / rules.subtiles_across; }

template <class T>
struct TileBoxesOf {
  PixelRectOf<IndexOf<T>> tiles;  // in tiles
  PixelRectOf<IndexOf<T>> parts;  // in sub-tiles of 4 px
  OrientedBox<T> box;             // used where it is to be asked
  BoxLimits<T> tile, part;        // then: of a tile and of a part of one
};
using TileBoxes = TileBoxesOf<float>;

// From the square of 3 sigma to sub-tiles of 4 px, by the rule of tile_rect().
template <class T>
PixelRectOf<IndexOf<T>> subtile_rect(const Projected<T>& p, const View<T>& view) {
  const auto count = [](int px) { return (px + kSubtilePx - 1) / kSubtilePx; };
  const int columns = count(view.width), rows = count(view.height);
  const T side = constant<T>(kSubtilePx), last = constant<T>(kSubtilePx - 1);
  return {truncated_index(T(T(p.x - p.radius) / side), columns),
          truncated_index(T(T(p.y - p.radius) / side), rows),
          truncated_index(T(T(p.x + p.radius + last) / side), columns),
          truncated_index(T(T(p.y + p.radius + last) / side), rows)};
}

// A Gaussian's splat without colour, and its boxes. False where it is seen nowhere.
template <class T>
bool make_tile_geometry(const View<T>& view, const Gaussian<T>& g, const TileRules& rules,
                        SplatOf<T>& splat, TileBoxesOf<T>& boxes) {
  using Index = IndexOf<T>;
  Projected<T> p;
  if (!make_geometry(view, g, splat, p)) return false;
  T reach = T(static_cast<float>(kRadiusSigmas * kRadiusSigmas));
  if (rules.reach == TileReach::kVisible) {
    const auto& f = splat.footprint;
    boxes.parts = {Index(f.x0), Index(f.y0), Index(f.x1), Index(f.y1)};
    constexpr int kMore = kSubtilesPerTile - 1;
    boxes.tiles = {boxes.parts.x0 / kSubtilesPerTile, boxes.parts.y0 / kSubtilesPerTile,
                   (boxes.parts.x1 + kMore) / kSubtilesPerTile,
                   (boxes.parts.y1 + kMore) / kSubtilesPerTile};
    reach = visible_cutoff(g.opacity);
  } else {
    boxes.tiles = tile_rect(p.x, p.y, p.radius, view.width, view.height);
    boxes.parts = subtile_rect(p, view);
  }
  const bool several = boxes.tiles.x0 + 1 < boxes.tiles.x1 || boxes.tiles.y0 + 1 < boxes.tiles.y1;
  boxes.box = {};
  if (rules.test == TileTest::kOriented && several) {
    boxes.box = oriented_box(p, reach);
    if (boxes.box.used) {
      boxes.tile = box_limits(boxes.box, kTilePx);
      boxes.part = box_limits(boxes.box, part_px(rules));
    }
  }
  return true;
}

// True if the box along the ellipse touches a tile among boxes.tiles, or if there is no such box.
template <class T>
bool touches_tile(const TileBoxesOf<T>& boxes, IndexOf<T> tile_x, IndexOf<T> tile_y) {
  using Index = IndexOf<T>;
  if (!boxes.box.used) return true;
  return touches(boxes.tile,
                 box_offset(boxes.box, Index(tile_x * kTilePx), Index(tile_y * kTilePx), kTilePx));
}

// The bitmap of such a tile: a bit for each part, row by row, that the splat may touch.
template <class T>
std::uint32_t part_bitmap(const TileBoxesOf<T>& boxes, const TileRules& rules, IndexOf<T> tile_x,
                          IndexOf<T> tile_y) {
  using Index = IndexOf<T>;
  if (rules.subtiles_across == 1) return 1;
  const int across = rules.subtiles_across, in_part = kSubtilesPerTile / across;
  std::uint32_t bits = 0;
  for (int part = 0; part < across * across; ++part) {
    const Index x = tile_x * kSubtilesPerTile + part % across * in_part;
    const Index y = tile_y * kSubtilesPerTile + part / across * in_part;
    const bool in_box = x < boxes.parts.x1 && y < boxes.parts.y1 && boxes.parts.x0 < x + in_part &&
                        boxes.parts.y0 < y + in_part;
    if (!in_box) continue;
    if (boxes.box.used && !touches(boxes.part, box_offset(boxes.box, Index(x * kSubtilePx),
                                                          Index(y * kSubtilePx), part_px(rules)))) {
      continue;
    }
    bits |= 1U << part;
  }
  return bits;
}

// The same of any tile among boxes.tiles; 0: not in this tile's list.
template <class T>
std::uint32_t tile_bitmap(const TileBoxesOf<T>& boxes, const TileRules& rules, IndexOf<T> tile_x,
                          IndexOf<T> tile_y) {
  return touches_tile(boxes, tile_x, tile_y) ? part_bitmap(boxes, rules, tile_x, tile_y) : 0;
}

}  // namespace sgs
