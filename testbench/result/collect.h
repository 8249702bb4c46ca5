// From data sheets to values.
#pragma once

#include "modules/machine.h"
#include "testbench/result/frame_result.h"

namespace sgs {

// Collects the values that a machine's data sheets have now. Open intervals of its activities are
// closed.
MachineResult collect(Machine& machine);

// Its savings alone, of whoever publishes them.
class LeftOutCollector : public DataSheet {
 public:
  explicit LeftOutCollector(std::vector<LeftOut>& into) : into_(into) {}
  // Nothing left out is not listed; counts under one name are added up.
  void left_out(const char* what, const char* why, std::uint64_t count,
                const std::string& saves) override;

 private:
  std::vector<LeftOut>& into_;
};

// FIFOs are empty and memory ports idle.
bool drained(Machine& machine);

// "machine.hfu0.coarse" below "machine": "hfu0.coarse"; the machine itself: "machine".
std::string path_below(const sc_core::sc_object& object, const Machine& machine);

}  // namespace sgs
