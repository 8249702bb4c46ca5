// Random requests into a channel, its commands into the independent checker.
#pragma once

#include <cstdint>
#include <string>

#include "modules/dram/dram_config.h"
#include "modules/dram/trace_checker.h"

namespace sgs::test {

struct RandomRun {
  std::uint64_t commands = 0;
  std::uint64_t served = 0;
  std::uint64_t pushed = 0;
  std::string violation;  // empty: none
};

// Requests of changing locality, direction mix, length and density (idle times up to some refresh
// intervals) until about `commands` commands have been sent. `queued`: the queued channel, else
// the arrival-order one.
RandomRun run_queued(const DramConfig& config, std::uint64_t commands, std::uint64_t seed);
RandomRun run_arrival_order(const DramConfig& config, std::uint64_t commands, std::uint64_t seed);

// Configurations that between them use every policy, mode and shipped memspec; `index` of
// kRandomConfigs.
constexpr std::uint32_t kRandomConfigs = 40;
DramConfig random_config(std::uint32_t index);

}  // namespace sgs::test
