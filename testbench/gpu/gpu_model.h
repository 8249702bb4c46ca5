// Time, bytes and energy of a frame of the original rasteriser on a GPU, modelled: each kernel
// takes as long as its instructions or its bytes, whichever is longer; kernels one after the other.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "algorithm/splat/gaussian.h"
#include "algorithm/splat/view.h"
#include "modules/config/config_visitor.h"

namespace sgs {

// A mobile GPU, as far as an analytic model needs it: peaks as published, and how much of them the
// original rasteriser gets.
struct GpuConfig {
  // Orin NX 16 GB.
  double clock_mhz = 918;
  int schedulers = 32;  // 8 multiprocessors of 4, a warp's instruction a cycle each
  double bandwidth_gb_s = 102.4;
  double cache_mb = 4;
  double watts = 6.2;  // joules of a published frame over the time of the calibration: README.md
  // Shares of the peak issue rate and peak bandwidth that are reached: calibrated, see README.md.
  double issue_share = 0.125, bandwidth_share = 0.125;

  double instructions_a_second() const { return clock_mhz * 1e6 * schedulers * issue_share; }
  double bytes_a_second() const { return bandwidth_gb_s * 1e9 * bandwidth_share; }
};

inline void visit(ConfigVisitor& v, GpuConfig& c) {
  v("clock_mhz", c.clock_mhz, in_range(1, 10'000), "MHz, of the multiprocessors");
  v("schedulers", c.schedulers, in_range(1, 100'000), "instructions of warps a cycle at most");
  v("bandwidth_gb_s", c.bandwidth_gb_s, in_range(0.1, 100'000), "GB/s, peak of the memory");
  v("cache_mb", c.cache_mb, in_range(0, 10'000), "MB, last level");
  v("watts", c.watts, in_range(0.1, 10'000), "W, of module and memory while it renders");
  v("issue_share", c.issue_share, in_range(0.001, 1), "of the instructions that it could issue");
  v("bandwidth_share", c.bandwidth_share, in_range(0.001, 1), "of the peak bandwidth");
}

// Operations of the original rasteriser (Kerbl et al. 2023) for a frame, counted by doing them.
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

// The parts of a frame for which shares of traffic are published.
enum class GpuPart { kProjection, kSorting, kRendering };

struct GpuStage {
  std::string name;
  GpuPart part;
  double instructions = 0;        // counted in warps
  double scene_bytes = 0;         // parameters of Gaussians
  double intermediate_bytes = 0;  // between kernels, written and read
  double frame_bytes = 0;         // pixels
  double seconds = 0;
  bool bound_by_bytes = false;

  double bytes() const { return scene_bytes + intermediate_bytes + frame_bytes; }
};

struct GpuFrame {
  std::vector<GpuStage> stages;
  double seconds = 0, joules = 0;

  double bytes() const;
  double bytes_of(GpuPart part) const;
  double intermediate_bytes() const;
};

GpuFrame model_gpu(const RasterWork& work, const GpuConfig& config);

}  // namespace sgs
