// Which 16x16 tiles a splat is listed in, and which parts of such a tile it may touch: what a
// tile-centric machine decides when it projects a Gaussian.
#pragma once

#include <cstdint>

#include "algorithm/splat/make_splat.h"
#include "algorithm/splat/oriented_box.h"

namespace sgs {

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

// Whether a tile among boxes.tiles is touched by the box along the ellipse, where there is one.
template <class T>
bool touches_tile(const TileBoxesOf<T>& boxes, IndexOf<T> tile_x, IndexOf<T> tile_y) {
  using Index = IndexOf<T>;
  if (!boxes.box.used) return true;
  return touches(boxes.tile,
                 box_offset(boxes.box, Index(tile_x * kTilePx), Index(tile_y * kTilePx), kTilePx));
}

// Of such a tile: a bit for each part, row by row, that the splat may touch.
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
