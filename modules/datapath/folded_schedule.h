// A computation on fewer lanes than it has steps: the cycle in which each step begins. The next
// item can begin `interval` cycles later, and the same lanes do the same steps for it (a modulo
// schedule). Its end is the depth of the pipeline; the longest path, which has a lane for each
// step, bounds it from below.
#pragma once

#include <cstdint>
#include <vector>

#include "modules/datapath/lane_steps.h"
#include "tlm/datapath.h"

namespace sgs {

// Each part begins a step a cycle.
struct FoldedParts {
  std::uint32_t lanes = 1, comparators = 0, tables = 0;
  std::uint32_t interval_cycles = 1;  // between items

  std::uint32_t of(StepBy by) const {
    const StepBy kind = part_kind(by);
    return kind == StepBy::kLane ? lanes : kind == StepBy::kComparator ? comparators : tables;
  }
};

struct FoldedSchedule {
  std::vector<std::uint32_t> begins;  // [step], cycle; a value from outside: when it comes
  std::uint32_t cycles = 0;           // until all is done
  std::vector<DatapathLoop> loops;    // [list] of values that come together
};

// Greedy: the step with the longest way to the end first, at the first cycle in which a part is
// free for it in all items; and the same backward; the shorter of the two. Throws std::logic_error
// where the parts have fewer turns in an interval than there are steps.
FoldedSchedule folded_schedule(const std::vector<LaneStep>& steps, const FoldedParts& parts,
                               const OperationLatencies& latencies);

// The same with fewer values that wait. Each step in turn goes to where its sources' lives and its
// own value's are shortest together, as long as a part is free there. The end comes no later; steps
// that depend on values that come when they are needed stay. An early sum lets two values go for
// one; a late quotient lets none wait.
void shorten_lives(const std::vector<LaneStep>& steps, const FoldedParts& parts,
                   const OperationLatencies& latencies, FoldedSchedule& schedule);

// Parts that are enough for these steps at this interval.
FoldedParts at_least(FoldedParts parts, const std::vector<LaneStep>& steps);

}  // namespace sgs
