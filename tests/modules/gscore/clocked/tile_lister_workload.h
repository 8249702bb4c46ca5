// Workloads of the tile lister: what the CCUs hand on, for the unit and for its clocked reference.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "algorithm/splat/make_splat.h"
#include "algorithm/splat/tile_boxes.h"
#include "testbench/units/gscore_bench.h"
#include "testbench/units/random_scene.h"
#include "tests/modules/gscore/clocked/clocked_tile_tests.h"

namespace sgs::test {

using namespace gscore;

constexpr int kListerWidth = 200, kListerHeight = 120;

struct ListerWorkload {
  const char* name;
  std::size_t gaussians = 400;
  ListsConfig lists;
  std::uint32_t in_one_in = 1, in_longest = 1;      // a CCU
  std::uint32_t core_one_in = 1, core_longest = 1;  // a core, from a tile to the next
  PortHardware port = {};
  std::uint32_t ccus = 4, cores = 4;
  int subtiles_across = 2;
};

inline ListsConfig lists_config(std::uint32_t lines, std::uint32_t tiles = 104) {
  ListsConfig lists;
  lists.lines = lines;
  lists.tiles = tiles;
  lists.pool_bytes = 8 << 20;  // that none overflows
  return lists;
}

inline GscoreConfig config_of(const ListerWorkload& load) {
  GscoreConfig config;
  config.ccus = load.ccus;
  config.cores = load.cores;
  config.lists = load.lists;
  config.tiles.subtiles_across = load.subtiles_across;
  return config;
}

// What the CCUs hand on in a pass.
struct ConvertedScene {
  std::uint32_t gaussians = 0;               // some of them on no tile
  std::vector<std::vector<Converted>> ccus;  // [CCU]
};
inline ConvertedScene converted_of(const ListerWorkload& load, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  tb::SceneShape shape;
  shape.gaussians = load.gaussians;
  shape.width_px = kListerWidth;
  shape.height_px = kListerHeight;
  const tb::TestScene scene = tb::random_scene(random, shape);
  const GscoreConfig config = config_of(load);
  const std::size_t size = config.ccu.slice_gaussians;
  ConvertedScene out{static_cast<std::uint32_t>(scene.cloud.size()), {}};
  out.ccus.resize(load.ccus);
  for (std::size_t i = 0; i < scene.cloud.size(); ++i) {
    Converted next;
    next.there = make_tile_geometry(scene.job.view, scene.cloud.gaussians[i], config.tiles.rules(),
                                    next.splat, next.boxes);
    next.end_of_pass = i + 1 == scene.cloud.size();
    next.last = (i + 1) % size == 0 || next.end_of_pass;
    if (next.there || next.last) out.ccus[i / size % load.ccus].push_back(next);
  }
  return out;
}

inline std::uint64_t tile_of(std::uint64_t tile, std::uint64_t entries) {
  return tile << 32U | entries;
}

// Of the tiles of a pass.
inline ClockedGaussian gaussian_of(const Converted& from, const GscoreConfig& config,
                                   std::uint32_t first, std::uint32_t end) {
  constexpr int kColumns = (kListerWidth + kTilePx - 1) / kTilePx;
  ClockedGaussian out;
  out.last = from.last;
  if (!from.there) return out;
  const PixelRect& tiles = from.boxes.tiles;
  const int at_once = static_cast<int>(config.lists.tiles_at_once);
  bool is_first = true;
  for (int y = tiles.y0; y < tiles.y1; ++y) {
    const auto row = static_cast<std::uint32_t>(y * kColumns);
    if (row + kColumns <= first || row >= end) continue;
    for (int x = tiles.x0; x < tiles.x1; x += at_once) {
      out.steps.emplace_back();
      for (int k = x; k < std::min(x + at_once, tiles.x1); ++k) {
        ClockedTile tile{row + static_cast<std::uint32_t>(k)};
        if (tile.tile < first || tile.tile >= end || !touches_tile(from.boxes, k, y)) continue;
        tile.listed = part_bitmap(from.boxes, config.tiles.rules(), k, y) != 0;
        tile.first = tile.listed && is_first;
        is_first = is_first && !tile.listed;
        out.steps.back().push_back(tile);
      }
    }
  }
  return out;
}

}  // namespace sgs::test
