// Frames at a fixed rate: the joules of one and of the rest until the next one begins.
#pragma once

#include "testbench/cost/cost.h"

namespace sgs {

struct FixedRate {
  double per_s = 0;   // frames
  bool held = false;  // the frame is done before the next one begins; else nothing below is known
  double rest_s = 0;
  double power_down_s = 0, self_refresh_s = 0;  // of the rest, as the memory's ranks spend it
  // High: at least as in power-down, for a controller that does not let the memory refresh itself.
  CostResult rest_j;
  Band energy_j;                  // of frame and rest, as the table counts
  Totals totals_j;                // the same
  Band memory_interface_w;        // in the rest
  std::string memory_not_stated;  // as MemoryResult has it, of frame and rest
  Band power_w() const { return per_s * energy_j; }
  Totals totals_w() const { return per_s * totals_j; }
};

// dram: of the frame's simulation. Throws InputError as energy_of().
FixedRate at_rate(double per_s, const FrameResult& frame, const DramConfig& dram,
                  const Technology& technology);

// Joules more, at the sources' highest, of a memory in power-down for so many seconds in which it
// refreshed itself. Throws InputError for its memspec.
double power_down_j(const DramConfig& dram, double seconds);

}  // namespace sgs
