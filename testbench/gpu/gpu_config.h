// A mobile GPU, as far as an analytic model needs it: peaks as published, and how much of them the
// original rasteriser gets.
#pragma once

#include "modules/config/config_visitor.h"

namespace sgs {

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

}  // namespace sgs
