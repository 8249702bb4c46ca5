// A computation on the lanes that a unit has for it: when its steps are done, and the hardware
// between the parts. That hardware is registers that hold values until they are taken, and
// multiplexers at the inputs of parts and registers.
#pragma once

#include <cstdint>
#include <vector>

#include "modules/datapath/folded_schedule.h"

namespace sgs {

// Registers and multiplexers, for values of one width. A multiplexer of n words is n - 1 two-way
// selections for each bit of a word.
struct LaneWiring {
  std::uint32_t register_words = 0, select_words = 0;  // words that are built
  // Words that one item writes into registers and passes through two-way multiplexers.
  std::uint32_t words_written = 0, words_selected = 0;
};

// A value is in a register from the cycle in which it is there until the last step that takes it
// begins; one of a lane a cycle later, since its first is in the lane's own last register. A value
// wanted at the end stays until then; one from outside is there as a whole. Where
// it lasts longer than an interval, the next item's pushes it on into another register. Registers
// that are taken for a part of the interval are shared. An answer of a comparison, a bit, is left
// out, and so are a lane's own stages. A constant, which may be of the frame or of the group, has
// its place.
LaneWiring lane_wiring(const std::vector<LaneStep>& steps, const FoldedSchedule& schedule,
                       const FoldedParts& parts, const OperationLatencies& latencies);

// The most values that are alive in one cycle, of all items that are under way: no wiring has fewer
// registers.
std::uint32_t most_alive(const std::vector<LaneStep>& steps, const FoldedSchedule& schedule,
                         std::uint32_t interval_cycles, const OperationLatencies& latencies);

struct FoldedPipeline {
  FoldedParts parts;
  FoldedSchedule schedule;
  LaneWiring wiring;
};

// Uses these parts, or as many as the steps take at this interval if that is more: so where a
// machine charges less than was counted.
FoldedPipeline folded_pipeline(const std::vector<LaneStep>& steps, const FoldedParts& parts,
                               const OperationLatencies& latencies);

}  // namespace sgs
