// Operations of the original rasteriser (Kerbl et al. 2023) for a frame, counted by doing them.
#pragma once

#include <cstdint>

#include "algorithm/splat/gaussian.h"
#include "algorithm/splat/view.h"

namespace sgs {

struct RasterWork {
  int sh_degree = 0;
  std::uint64_t gaussians = 0;
  std::uint64_t in_front = 0;  // beyond the near plane: their covariance is computed
  std::uint64_t listed = 0;    // on a tile: coloured too
  std::uint64_t pairs = 0;     // (Gaussian, tile)
  std::uint64_t pair_steps =
      0;  // steps of warps that write pairs: most pairs of 32 neighbours, summed
  std::uint64_t tiles = 0, pixels = 0;
  std::uint64_t entries_fetched = 0;  // in whole batches of 256 until the tile is finished
  std::uint64_t warp_entries = 0;     // looked at by warps of 16 x 2 px with an unfinished pixel
  std::uint64_t warp_blends = 0;      // warp_entries that blend into at least one pixel
  std::uint64_t blends = 0;           // (Gaussian, pixel)
};

RasterWork count_raster_work(const View<float>& view, const ActivatedCloud& cloud);

}  // namespace sgs
