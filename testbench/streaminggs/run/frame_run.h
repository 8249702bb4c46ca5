// One frame through a SystemC machine and memory, in a process of its own: the kernel elaborates
// once a process, and a scene is loaded once for all views.
#pragma once

#include <string>
#include <vector>

#include "algorithm/memory/scene_layout.h"
#include "modules/dram/dram_config.h"
#include "modules/machine_design.h"
#include "testbench/result/frame_result.h"
#include "testbench/streaminggs/run/shown_pictures.h"
#include "testbench/timeline/activity_track.h"

namespace sgs {

struct RunOptions {
  std::string vcd_path;             // empty: no waveform
  std::string timeline_path;        // empty: none
  GroupRange timeline_groups;       // groups that the timeline is limited to
  std::string dram_trace_path;      // empty: no trace of the DRAM commands
  std::vector<double> frame_rates;  // frames a second at which power is told
  BuildOptions build;
};

// Throws InputError when the machine takes more on-chip memory than it has, before its time begins;
// std::runtime_error, with the reason, when the simulation fails.
FrameResult run_frame(const MachineDesign& design, const FrameJob& job, const MemoryImage& image,
                      const DramConfig& dram, const RunOptions& options);

// The frames of a job back to back in one simulation, shown `rate` times a second; 0: each as soon
// as it is drawn, in no time. All of the result but its stream is of all frames together. shown:
// takes their pictures.
FrameResult simulate_stream(const MachineDesign& design, const FrameJob& job,
                            const MemoryImage& image, const DramConfig& dram, double rate,
                            const RunOptions& options, ShownPictures& shown);

// As run_frame() in this process, which can do so once, and without files. For a child of its own
// kind (testbench/process/child_process.h): an error of SystemC ends it.
FrameResult simulate_frame(const MachineDesign& design, const FrameJob& job,
                           const MemoryImage& image, const DramConfig& dram,
                           const BuildOptions& build);

}  // namespace sgs
