// A machine of two units: fetch -> write.
#pragma once

#include <systemc>

#include "modules/machine.h"
#include "modules/machine_design.h"
#include "tests/testbench/toy_machine/write_unit.h"

namespace sgs::toy {

class ToyMachine : public Machine {
 public:
  ToyMachine(const sc_core::sc_module_name& name, const ToyConfig& config, const FrameJob& job,
             const BuildOptions& options);

  const ClockDomain& clock() const override { return clock_; }
  void publish(DataSheet& sheet) override;

 private:
  const ToyConfig config_;
  const FrameJob job_;
  const ClockDomain clock_;
  TimedFifo<GroupColour> colours_;
  FetchUnit fetch_;
  WriteUnit write_;
};

}  // namespace sgs::toy
