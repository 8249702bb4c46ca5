// Joules and square millimetres: amounts of work and of parts times a technology's table.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "testbench/cost/technology.h"
#include "testbench/result/frame_result.h"

namespace sgs {

// By component, in the order in which the data sheets name them.
struct CostResult {
  std::vector<std::pair<std::string, double>> by_component;
  double total = 0;
};

// Joules of the machine's work, the leakage of its parts over the frame (component
// `<part's>_leakage`) and the memory's (`dram`). Throws InputError for work that the table has no
// row for.
CostResult energy_of(const FrameResult& frame, const Technology& technology);

// Square millimetres of the parts that stand there. Throws InputError as above.
CostResult area_of(const MachineResult& machine, const Technology& technology);

}  // namespace sgs
