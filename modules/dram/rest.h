// The memory between two frames: no request comes, and the controller knows until when.
#pragma once

#include <cstdint>
#include <vector>

#include "modules/dram/dram_config.h"
#include "modules/dram/dram_energy.h"
#include "modules/dram/memspec.h"

namespace sgs {

struct Rest {
  std::uint64_t cycles = 0;
  std::vector<RankActivity> ranks;  // by data bus and rank, as DramStats has them
  DramEnergyBand energy;

  // Share of the time in self-refresh, and in either power-down, of all ranks; 0 to 1.
  double self_refresh() const;
  double power_down() const;
};

// From the last datum of a frame: all rows are closed, ranks go where config.between_frames sends
// them, and leave it so early that they are up at the end, the refresh after self-refresh done. A
// rest that is too short for that is spent in standby. Refresh is due as at the beginning of a
// frame.
Rest rest_of(const DramConfig& config, const Memspec& memspec, std::uint64_t cycles);

}  // namespace sgs
