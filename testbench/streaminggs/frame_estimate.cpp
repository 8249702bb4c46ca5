// A machine without a kernel's time.
#include "testbench/streaminggs/frame_estimate.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <systemc>

#include "algorithm/memory/frame_buffer.h"
#include "modules/dram/dram_estimate.h"
#include "testbench/process/in_child.h"
#include "testbench/process/sc_errors.h"
#include "testbench/result/collect.h"
#include "testbench/result/collect_memory.h"
#include "testbench/result/memory_path.h"
#include "testbench/result/sram_budget.h"
#include "testbench/result/wire.h"
#include "tlm/time_resolution.h"

namespace sgs {

FrameResult estimate_frame(const MachineDesign& design, const FrameJob& job, const FrameWork& work,
                           const DramConfig& dram) {
  const auto began = std::chrono::steady_clock::now();
  use_femtosecond_resolution();
  sc_core::sc_report_handler::set_actions(sc_core::SC_INFO, sc_core::SC_DO_NOTHING);
  fail_child_on_sc_error();
  const std::unique_ptr<Machine> machine = design.build("accelerator", job, {});
  check_sram_budget(*machine);
  DramEstimate memory(dram, machine->clock().mhz());
  FrameResult result;
  result.fidelity = Fidelity::kEstimate;
  result.cycles = machine->estimate(work, memory);
  result.cycles = std::max(result.cycles, memory.least_cycles());
  result.clock_mhz = machine->clock().mhz();
  result.drained = true;
  result.machine = collect(*machine);
  add_memory_path(*machine, dram.channels, result.machine);
  result.memory =
      collect_memory(memory.stats(result.cycles), job.layout.regions, machine->requesters());
  result.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return result;
}

FrameResult run_estimate(const MachineDesign& design, const FrameJob& job,
                         const CountedFrame& counted, const DramConfig& dram) {
  const std::string bytes =
      in_child([&] { return to_wire(estimate_frame(design, job, *counted.work, dram)); });
  FrameResult result = from_wire(bytes);
  result.frame = encode_frame(job.frame_format, counted.golden.image);
  return result;
}

}  // namespace sgs
