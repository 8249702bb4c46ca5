// Joules and square millimetres: what was done and what stands there, times a technology's table.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "modules/dram/rest.h"
#include "testbench/cost/technology.h"
#include "testbench/result/frame_result.h"

namespace sgs {

// By component, in the order in which the data sheets name them.
struct CostResult {
  std::vector<std::pair<std::string, Band>> by_component;
  Band total;
};

// Square millimetres of the parts, by component, and of the on-chip memory that is used (`sram`).
// Throws InputError for a part that the table has no row for.
CostResult area_of(const FrameResult& frame, const Technology& technology);

// A sum without and with PHY and controller of the memory's channels, whether the table counts
// these or not; and these alone.
struct Totals {
  Band without_memory_interface, with_memory_interface, memory_interface;
};
inline Totals operator+(const Totals& a, const Totals& b) {
  return {a.without_memory_interface + b.without_memory_interface,
          a.with_memory_interface + b.with_memory_interface,
          a.memory_interface + b.memory_interface};
}
inline Totals operator*(double factor, const Totals& a) {
  return {factor * a.without_memory_interface, factor * a.with_memory_interface,
          factor * a.memory_interface};
}

// Of the whole area in mm2.
Totals area_totals(const FrameResult& frame, const Technology& technology);

// Square millimetres of each owner, its on-chip memory included, and of PHY and controller of the
// memory's channels (`memory_interface`). Throws InputError as above.
CostResult area_by_owner(const FrameResult& frame, const Technology& technology);

// Joules of the operations, by component; of the accesses, by use of on-chip memory; of the clock
// (`clock`), which stands while no frame is under way; of leakage over the frame (`logic_leakage`,
// `sram_leakage`); and the memory's
// (`dram`), none where that is not known. Throws InputError as above.
CostResult energy_of(const FrameResult& frame, const Technology& technology);
Totals energy_totals(const FrameResult& frame, const Technology& technology);

// Joules of what was done between two moments of one simulation.
CostResult energy_between(const FrameResult& from, const FrameResult& until,
                          const Technology& technology);

// Power of PHY and controller between frames, whether the table counts them or not: while the
// memory refreshes itself their clocks stand and they leak as logic does; else as in a frame. High:
// as in a frame all the time, as in every time that they are counted for.
Band resting_interface_w(const FrameResult& frame, const Rest& rest, const Technology& technology);

// Joules between a frame and the next one, in which the machine's clock stands: leakage
// (`logic_leakage`, `sram_leakage`), the memory's (`dram`) where it is known, and
// `memory_interface` where the table counts it.
CostResult rest_energy_of(const FrameResult& frame, const Rest& rest, double seconds,
                          const Technology& technology);
Totals rest_energy_totals(const FrameResult& frame, const Rest& rest, double seconds,
                          const Technology& technology);

// Energy of all accesses of one use of on-chip memory, in joules.
Band access_energy_j(const MachineResult& machine, const SramUse& use, const SramModel& model);

}  // namespace sgs
