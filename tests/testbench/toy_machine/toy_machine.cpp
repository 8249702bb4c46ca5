// Wiring and data sheet of the toy machine.
#include "tests/testbench/toy_machine/toy_machine.h"

namespace sgs::toy {

ToyMachine::ToyMachine(const sc_core::sc_module_name& name, const ToyConfig& config,
                       const FrameJob& job, const BuildOptions& options)
    : Machine(name),
      config_(config),
      job_(job),
      clock_(config.clock_mhz, options.jitter_seed),
      colours_("colours", clock_, config.queue_entries),
      fetch_("fetch", config_, clock_, job_),
      write_("write", config_, clock_, job_, [this] { finish_frame(0, true); }) {
  if (options.stalls.probability > 0) colours_.inject(options.stalls);
  fetch_.colours(colours_);
  write_.colours(colours_);
  connect_memory(1);
}

void ToyMachine::publish(DataSheet& sheet) {
  fetch_.publish(sheet);
  write_.publish(sheet);
  sheet.unit(*this);
  sheet.sram(fifo_use<GroupColour>("colours", kScratch, config_.queue_entries, "colours"));
  sheet.queue(colours_, "colours");
  sheet.sram_available(kScratch, kScratchBytes);
}

}  // namespace sgs::toy
