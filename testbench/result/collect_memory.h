// The memory's counts and joules as values.
#pragma once

#include <string>
#include <vector>

#include "algorithm/memory/regions.h"
#include "modules/dram/dram_stats.h"
#include "testbench/result/frame_result.h"

namespace sgs {

// requesters: by number.
MemoryResult collect_memory(const DramStats& stats, const Regions& regions,
                            const std::vector<std::string>& requesters);

}  // namespace sgs
