// The memory's counts and joules as values.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "algorithm/memory/scene_layout.h"
#include "modules/dram/dram_stats.h"
#include "testbench/result/collect.h"
#include "testbench/result/frame_result.h"

namespace sgs {

// The path between a machine's memory ports and the channels' controllers, paid by the machine.

// Adds parts and operations of component "memory_path": for each port and direction the registers
// of the path, and for each channel a multiplexer, a bit each; what passed them. With an urgent port
// besides each channel's entries for urgent reads, and a way out of them. The parts' owner has the
// component's name.
void add_memory_path(const Publisher& all, std::uint32_t channels, MachineResult& result);

// requesters: by number.
MemoryResult collect_memory(const DramStats& stats, const Regions& regions,
                            const std::vector<std::string>& requesters);

}  // namespace sgs
