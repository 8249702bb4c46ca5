// Frames at a fixed rate: the joules of one and of the rest until the next one begins.
#pragma once

#include "testbench/cost/cost.h"

namespace sgs {

struct FixedRate {
  double per_s = 0;   // frames
  bool held = false;  // the frame is done before the next one begins; else nothing below is known
  double rest_s = 0;
  double power_down_s = 0, self_refresh_s = 0;  // of the rest, as the memory's ranks spend it
  CostResult rest_j;
  Band energy_j;                          // of frame and rest
  Band memory_interface_w;                // in the rest
  bool memory_interface_counted = false;  // it is part of these joules
  std::string memory_not_stated;          // as MemoryResult has it, of frame and rest
  Band power_w() const { return per_s * energy_j; }
};

// energy_j: of the frame. dram: of its simulation. Throws InputError as energy_of().
FixedRate at_rate(double per_s, const FrameResult& frame, const Band& energy_j,
                  const DramConfig& dram, const Technology& technology);

}  // namespace sgs
