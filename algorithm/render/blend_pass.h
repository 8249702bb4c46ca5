// One pass over all splats of a frame, front to back: whatever looks at the reference image splat
// by splat (the image itself, weights, gradients) is this loop with another body. Each pixel is C =
// sum_i c_i alpha_i T_i + T_end background, T_i = prod_{j<i} (1 - alpha_j): equation 3 of Kerbl et
// al. 2023, with the thresholds of its released rasteriser (splat/constants.h).
#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "algorithm/render/group_state.h"
#include "algorithm/splat/constants.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/splat/rects.h"
#include "algorithm/splat/splat.h"
#include "algorithm/splat/view.h"

namespace sgs {

// The sorting key of one Gaussian of a frame.
struct DepthKey {
  std::uint32_t depth_bits;  // v_z as float: positive floats order like their bit patterns
  std::uint32_t index;       // in the cloud
};

// Sorts by (depth, index). keys: by ascending index, fewer than 2^32.
void sort_front_to_back(std::vector<DepthKey>& keys);

// Only the keys of the whole frame are held (16 B a Gaussian near the frustum); splats are made as
// they are asked for. The same bits whatever the number of threads.
class SplatSequence {
 public:
  // Finds and sorts the Gaussians that may be visible. `cloud` must outlive the sequence. Throws
  // InputError when the cloud has 2^32 Gaussians or more.
  SplatSequence(const View<float>& view, const ActivatedCloud& cloud);

  // The keys of all Gaussians near the frustum, by (depth, index).
  const std::vector<DepthKey>& keys() const { return keys_; }

  bool at_end() const { return next_ == keys_.size(); }

  // Makes `batch` the splats, coloured, of the next `most` keys or of as many as there are. The
  // keys of Gaussians that turn out to be invisible give none: a batch may be empty before the end.
  void next(std::size_t most, std::vector<Splat>& batch);

 private:
  const View<float> view_;
  const ActivatedCloud& cloud_;
  std::vector<DepthKey> keys_;
  std::size_t next_ = 0;
};

// A grid of equal cells over the frame, row by row from the top left.
struct CellGrid {
  int columns = 0, rows = 0;
  int cell_columns = 0, cell_rows = 0;  // size of a cell, in sub-tiles of 4 px
  std::size_t size() const { return static_cast<std::size_t>(columns) * rows; }
};

// cell: multiples of 4.
CellGrid cell_grid(int width_px, int height_px, const PixelSize& cell);

// Cells [x0, x1) x [y0, y1) that a non-empty footprint overlaps.
struct CellRect {
  int x0, y0, x1, y1;
  std::size_t size() const { return static_cast<std::size_t>(x1 - x0) * (y1 - y0); }
};
CellRect cells_of(const CellGrid& grid, const SubtileRect& footprint);

// How many of splats[begin ..) can be binned at once, at least one: bins of giants would fill the
// memory.
std::size_t binnable(const CellGrid& grid, const std::vector<Splat>& splats, std::size_t begin);

struct SplatBins {
  std::vector<std::size_t> first;      // [cells + 1] where each cell's list begins
  std::vector<std::uint32_t> entries;  // positions in the splats given, ascending in each cell
};

// Bins splats[0 .. count) by their footprints. 4 bytes a (splat, cell) pair.
SplatBins bin_splats(const CellGrid& grid, const Splat* splats, std::size_t count);

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
