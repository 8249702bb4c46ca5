// One frame through the SystemC accelerator, in a process of its own: the kernel elaborates once a
// process, and a scene is loaded once for all views.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "algorithm/memory/memory_image.h"
#include "modules/accelerator_config.h"
#include "modules/frame_job.h"
#include "tlm/memory_port.h"

namespace sgs {

struct RunOptions {
  TimingMode timing = TimingMode::kAccurate;
  std::string vcd_path;          // empty: no waveform
  std::string dram_trace_path;   // empty: no trace of the DRAM commands
  double stall_probability = 0;  // of a random stall at each side of each FIFO, for tests
  std::uint64_t seed = 1;        // of those stalls
};

struct FrameRun {
  std::vector<std::byte> frame;   // the frame buffer as read back from the modelled DRAM
  std::string measurements_json;  // what measure() of measurements.h says
  double wall_s = 0;              // elaboration, loading of the memory, simulation
};

// Throws std::runtime_error when the simulation fails; the reason has gone to stderr.
FrameRun run_frame(const AcceleratorConfig& config, const FrameJob& job, const MemoryImage& image,
                   const RunOptions& options);

}  // namespace sgs
