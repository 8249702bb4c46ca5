// One pass over all splats of a frame, front to back: whatever looks at the reference image splat
// by splat (the image itself, weights, gradients) is this loop with another body. Each pixel is C =
// sum_i c_i alpha_i T_i + T_end background, T_i = prod_{j<i} (1 - alpha_j): equation 3 of Kerbl et
// al. 2023, with the thresholds of its released rasteriser (splat/constants.h).
#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "algorithm/render/group_state.h"
#include "algorithm/render/splat_bins.h"
#include "algorithm/render/splat_sequence.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/splat/view.h"

namespace sgs {

// One splat in one pixel: the pixel gains alpha before times its colour.
struct PixelBlend {
  int x, y;             // px
  float alpha;          // after cap and threshold, never 0
  float before, after;  // T in front of the splat and behind it: after = before - alpha before
};

// An observer of GroupState::blend that shows `observe` each pixel that is blended, as PixelBlend.
template <class Observe>
auto each_pixel(Observe observe) {
  return [observe](const SubtileBlend& blend) {
    for (int lane = 0; lane < kSubtilePixels; ++lane) {
      if (blend.shares.alpha[lane] == 0) continue;
      observe(PixelBlend{blend.x * kSubtilePx + lane % kSubtilePx,
                         blend.y * kSubtilePx + lane / kSubtilePx, blend.shares.alpha[lane],
                         blend.shares.before[lane], blend.behind.transmittance[lane]});
    }
  };
}

// Calls blend_into(tile, splat) for each tile of such a size (multiples of 4) and splat of the
// frame that falls on it, until the tile is finished; returns the tiles, row by row. blend_into is
// to call tile.blend(splat), with an observer or without, or to leave the splat out. A tile gets
// its splats one after the other, by (depth, index); different tiles are blended at the same time,
// so what blend_into adds up across tiles must bear that (fixed_point_sums.h).
template <class BlendInto>
std::vector<GroupState> blend_scene(const View<float>& view, const ActivatedCloud& cloud,
                                    const BlendInto& blend_into,
                                    const PixelSize& tile = square_of(kTilePx)) {
  // Batches bound the memory of splats and bins, keep them in the cache and end the frame early
  // when every tile is finished.
  constexpr std::size_t kBatchSplats = 32768;
  const CellGrid grid = cell_grid(view.width, view.height, tile);
  std::vector<GroupState> tiles;
  tiles.reserve(grid.size());
  for (const PixelRect& pixels : pixel_groups(view.width, view.height, tile)) {
    tiles.emplace_back(pixels, view.width, view.height);
  }
  const auto blend_run = [&](const Splat* splats, std::size_t count) {
    const SplatBins bins = bin_splats(grid, splats, count);
    tbb::parallel_for(std::size_t{0}, grid.size(), [&](std::size_t at) {
      for (std::size_t i = bins.first[at]; i != bins.first[at + 1]; ++i) {
        if (tiles[at].saturated()) return;
        blend_into(tiles[at], splats[bins.entries[i]]);
      }
    });
  };
  const auto unfinished = [](const GroupState& state) { return !state.saturated(); };
  SplatSequence sequence(view, cloud);
  std::vector<Splat> batch;
  while (!sequence.at_end() && std::any_of(tiles.begin(), tiles.end(), unfinished)) {
    sequence.next(kBatchSplats, batch);
    for (std::size_t begin = 0; begin != batch.size();) {
      const std::size_t count = binnable(grid, batch, begin);
      blend_run(batch.data() + begin, count);
      begin += count;
    }
  }
  return tiles;
}

}  // namespace sgs
