// Write unit of the toy machine: fills each group with its colour. Timing: pixels_per_cycle.
#pragma once

#include <cstdint>
#include <functional>
#include <systemc>

#include "tests/testbench/toy_machine/fetch_unit.h"

namespace sgs::toy {

class WriteUnit : public sc_core::sc_module {
 public:
  FifoIn<GroupColour> colours{"colours"};
  MemoryPort memory;

  SC_HAS_PROCESS(WriteUnit);
  // on_done() is called when the last pixel has been written.
  WriteUnit(const sc_core::sc_module_name& name, const ToyConfig& config, const ClockDomain& clock,
            const FrameJob& job, std::function<void()> on_done);

  static SramUses sram_uses(const ToyConfig& config);
  void publish(DataSheet& sheet);

 private:
  void run();  // thread
  void fill(const PixelRect& group, const glm::vec3& colour);

  const ToyConfig config_;
  const FrameJob& job_;
  std::function<void()> on_done_;
  Activity write_;
  struct Counters : CounterSet {
    Counter pixels{*this, "pixels", "pixels", "written"};
  } counters_;
};

}  // namespace sgs::toy
