// One frame reckoned by a SystemC machine that is built and does not run.
#pragma once

#include "modules/dram/dram_config.h"
#include "modules/machine_design.h"
#include "testbench/result/frame_result.h"

namespace sgs {

// work: of this job, as the design counts it; the frame is that of its picture. Throws InputError
// when the machine takes more on-chip memory than it has.
FrameResult run_estimate(const MachineDesign& design, const FrameJob& job,
                         const CountedFrame& counted, const DramConfig& dram);

// The same in this process, which can do so once, and without the frame. For a child of its own
// kind (testbench/process/child_process.h): an error of SystemC ends it.
FrameResult estimate_frame(const MachineDesign& design, const FrameJob& job, const FrameWork& work,
                           const DramConfig& dram);

}  // namespace sgs
