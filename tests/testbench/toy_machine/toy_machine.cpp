// Wiring and data sheet of the toy machine.
#include "tests/testbench/toy_machine/toy_machine.h"

#include "modules/construction.h"

namespace sgs::toy {

ToyMachine::ToyMachine(const sc_core::sc_module_name& name, const ToyConfig& config,
                       const FrameJob& job, const BuildOptions& options)
    : Machine(name),
      config_(config),
      job_(job),
      clock_(config.clock_mhz, options.process_order),
      colours_("colours", clock_, config.queue_entries) {
  if (options.stalls.probability > 0) colours_.inject(options.stalls);
  construct({[this] { fetch_ = std::make_unique<FetchUnit>("fetch", config_, clock_, job_); },
             [this] {
               write_ = std::make_unique<WriteUnit>("write", config_, clock_, job_,
                                                    [this] { finish_frame(); });
             }},
            options.process_order);
  fetch_->colours(colours_);
  write_->colours(colours_);
  connect_memory();
}

void ToyMachine::publish(DataSheet& sheet) {
  fetch_->publish(sheet);
  write_->publish(sheet);
  sheet.unit(*this);
  sheet.sram(fifo_use<GroupColour>("colours", kScratch, config_.queue_entries, "colours"));
  sheet.queue(colours_, "colours");
  sheet.sram_available(kScratch, kScratchBytes);
}

}  // namespace sgs::toy
