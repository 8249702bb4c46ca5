// The memory's counts and joules as values.
#pragma once

#include <string>
#include <vector>

#include "algorithm/memory/regions.h"
#include "modules/dram/dram_controller.h"
#include "testbench/result/frame_result.h"

namespace sgs {

// requesters: by number. Work that was left to do in idle time is caught up with.
MemoryResult collect_memory(DramController& memory, const Regions& regions,
                            const std::vector<std::string>& requesters);

}  // namespace sgs
