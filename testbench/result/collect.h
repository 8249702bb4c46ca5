// From data sheets to values.
#pragma once

#include <functional>
#include <vector>

#include "modules/machine.h"
#include "testbench/result/frame_result.h"

namespace sgs {

// Whoever publishes a machine's data sheets, and those of what stands beside it.
using Publisher = std::function<void(DataSheet&)>;

// Collects the values that the data sheets have now: the machine's, or those of `all`. Open
// intervals of activities are closed.
MachineResult collect(Machine& machine);
MachineResult collect(const Machine& machine, const Publisher& all);

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
bool drained(const Publisher& all);

// "machine.hfu0.coarse" below "machine": "hfu0.coarse"; the machine itself, and what does not lie
// below it, by its name.
std::string path_below(const sc_core::sc_object& object, const Machine& machine);

}  // namespace sgs
