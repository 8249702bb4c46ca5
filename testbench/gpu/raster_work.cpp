#include "testbench/gpu/raster_work.h"

#include <algorithm>

#include "algorithm/render/tile_renderer.h"
#include "algorithm/splat/projection.h"

namespace sgs {
namespace {

// The original lists by the square of 3 sigma and skips nothing.
TileOrderConfig original() {
  TileOrderConfig config;
  config.rules = {TileReach::kThreeSigma, TileTest::kBox, 1};
  config.features = config.keys = NumberFormat::kSingle;
  config.precision = BlendPrecision::kSingle;
  config.chunk_entries = 256;  // a batch: one for each thread of a tile
  return config;
}

// Tiles of a Gaussian; -1: not in front.
std::int64_t tiles_of(const View<float>& view, const Gaussian<float>& g) {
  if (!(to_camera(view, g.mean).z > static_cast<float>(kNearPlane))) return -1;
  Splat splat;
  TileBoxes boxes;
  if (!make_tile_geometry(view, g, original().rules, splat, boxes)) return 0;
  return std::int64_t{boxes.tiles.width()} * boxes.tiles.height();
}

}  // namespace

RasterWork count_raster_work(const View<float>& view, const ActivatedCloud& cloud) {
  constexpr std::size_t kWarp = 32;
  RasterWork work;
  work.sh_degree = cloud.sh_degree;
  work.gaussians = cloud.size();
  for (std::size_t first = 0; first < cloud.size(); first += kWarp) {
    std::int64_t most = 0;
    for (std::size_t i = first; i < std::min(first + kWarp, cloud.size()); ++i) {
      const std::int64_t tiles = tiles_of(view, cloud.gaussians[i]);
      work.in_front += tiles >= 0 ? 1 : 0;
      work.listed += tiles > 0 ? 1 : 0;
      work.pairs += static_cast<std::uint64_t>(std::max<std::int64_t>(tiles, 0));
      most = std::max(most, tiles);
    }
    work.pair_steps += static_cast<std::uint64_t>(most);
  }
  const TileOrderConfig config = original();
  const TileStats stats = render_tiles(view, cloud, config).stats;
  const auto tiles = [](int px) { return (px + kTilePx - 1) / kTilePx; };
  work.tiles = static_cast<std::uint64_t>(tiles(view.width)) * tiles(view.height);
  work.pixels = static_cast<std::uint64_t>(view.width) * view.height;
  work.entries_fetched = stats.chunk_entries_taken;
  work.warp_entries = stats.warp_entries;
  work.warp_blends = stats.warp_blends;
  work.blends = stats.contributors;
  return work;
}

}  // namespace sgs
