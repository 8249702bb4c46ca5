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

// Tiles are numbered frame after frame; of two eyes as if their pictures lay side by side.
struct GscoreJob : FrameJob {
  std::uint32_t columns = 0, tile_count = 0;  // of a row, of all eyes; of all frames
  RecordArray projected;                      // places of records, of one set after the other
  RegionSpan lists;                           // a pool of blocks for each set
  RegionSpan subsets;                         // a stack of blocks for each core
  std::uint32_t sets = 1;                     // of projected records and their lists

  std::uint32_t tiles_of_frame() const { return tile_count / frames(); }
  std::uint32_t frame_of(std::uint32_t tile) const { return tile / tiles_of_frame(); }
  const Picture& picture_of(std::uint32_t tile) const {
    return picture(frame_of(tile), eye_of(tile));
  }
  std::uint32_t first_tile(std::uint32_t frame) const { return frame * tiles_of_frame(); }
  PixelRect pixels(std::uint32_t tile) const {
    const int x = tile_x(tile) * kTilePx;
    const int y = tile_y(tile) * kTilePx;
    return {x, y, std::min(x + kTilePx, view.width), std::min(y + kTilePx, view.height)};
  }
  std::uint32_t columns_of_eye() const { return columns / eyes; }
  std::uint32_t eye_of(std::uint32_t tile) const { return tile % columns / columns_of_eye(); }
  // In the picture of its eye.
  int tile_x(std::uint32_t tile) const {
    return static_cast<int>(tile % columns % columns_of_eye());
  }
  int tile_y(std::uint32_t tile) const {
    return static_cast<int>(tile % tiles_of_frame() / columns);
  }
  std::uint64_t record_address(std::uint32_t set, std::uint64_t record) const {
    return projected.address(set * (projected.count / sets) + record);
  }
  RegionSpan lists_of(std::uint32_t set) const {
    return lists.part(set * (lists.bytes / sets), lists.bytes / sets);
  }
};

// Adds the working regions of a frame behind the scene's. Throws InputError where the pool of lists
// cannot hold every Gaussian in one tile.
void add_regions(const GscoreConfig& config, FrameJob& job);

// Tiles and regions of a job that has passed as a FrameJob.
GscoreJob gscore_job(const GscoreConfig& config, const FrameJob& job);

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
