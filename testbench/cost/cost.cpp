// Sums of energy and area.
#include "testbench/cost/cost.h"

namespace sgs {
namespace {

void add(CostResult& cost, const std::string& component, double amount) {
  cost.total += amount;
  for (auto& [name, sum] : cost.by_component) {
    if (name != component) continue;
    sum += amount;
    return;
  }
  cost.by_component.emplace_back(component, amount);
}

}  // namespace

CostResult energy_of(const FrameResult& frame, const Technology& technology) {
  constexpr double kPj = 1e-12, kMw = 1e-3;
  CostResult energy;
  for (const Amount& work : frame.machine.operations) {
    add(energy, work.component, work.count * technology.operation(work.kind).pj * kPj);
  }
  for (const Amount& part : frame.machine.parts) {
    const double mw = part.count * technology.part(part.kind).leakage_mw;
    if (mw > 0) add(energy, part.component + "_leakage", mw * kMw * frame.time_s());
  }
  add(energy, "dram", frame.memory.energy_j);
  return energy;
}

CostResult area_of(const MachineResult& machine, const Technology& technology) {
  CostResult area;
  for (const Amount& part : machine.parts) {
    add(area, part.component, part.count * technology.part(part.kind).mm2);
  }
  return area;
}

}  // namespace sgs
