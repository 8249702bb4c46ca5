// A frame as the units of the tile-centric machine know it.
#pragma once

#include <algorithm>
#include <cstdint>

#include "algorithm/splat/rects.h"
#include "modules/frame_job.h"
#include "modules/gscore/gscore_config.h"
#include "tlm/clock_domain.h"
#include "tlm/phase.h"

namespace sgs::gscore {

struct GscoreJob : FrameJob {
  std::uint32_t columns = 0, tile_count = 0;
  RecordArray projected;  // places of records
  RegionSpan lists;       // the pool of blocks
  RegionSpan subsets;     // a stack of blocks for each core

  PixelRect pixels(std::uint32_t tile) const {
    const int x = static_cast<int>(tile % columns) * kTilePx;
    const int y = static_cast<int>(tile / columns) * kTilePx;
    return {x, y, std::min(x + kTilePx, view.width), std::min(y + kTilePx, view.height)};
  }
  int tile_x(std::uint32_t tile) const { return static_cast<int>(tile % columns); }
  int tile_y(std::uint32_t tile) const { return static_cast<int>(tile / columns); }
};

// Adds the working regions of a frame behind the scene's. Throws InputError where the pool of lists
// cannot hold every Gaussian in one tile.
void add_regions(const GscoreConfig& config, FrameJob& job);

// Tiles and regions of a job that has passed as a FrameJob.
GscoreJob gscore_job(const FrameJob& job);

// Phases of a pass, one after the other.
struct Phases {
  Phase projecting;  // Gaussians, into lists of tiles
  Phase drawing;     // tiles are sorted and rendered
};

// Clock and job outlive the units.
struct UnitContext {
  const ClockDomain& clock;
  const GscoreJob& job;
  const GscoreConfig& config;
  Phases& phases;
};

}  // namespace sgs::gscore
