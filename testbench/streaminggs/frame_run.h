// One frame through a SystemC machine and memory, in a process of its own: the kernel elaborates
// once a process, and a scene is loaded once for all views.
#pragma once

#include <string>

#include "algorithm/memory/memory_image.h"
#include "modules/dram/dram_config.h"
#include "modules/machine_design.h"
#include "testbench/result/frame_result.h"

namespace sgs {

struct RunOptions {
  std::string vcd_path;         // empty: no waveform
  std::string dram_trace_path;  // empty: no trace of the DRAM commands
  BuildOptions build;
};

// Throws std::runtime_error when the simulation fails; the reason has gone to stderr.
FrameResult run_frame(const MachineDesign& design, const FrameJob& job, const MemoryImage& image,
                      const DramConfig& dram, const RunOptions& options);

}  // namespace sgs
