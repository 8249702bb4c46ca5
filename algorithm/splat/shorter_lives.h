// A schedule's steps moved within the time that they have, so that fewer values wait.
#pragma once

#include <vector>

#include "algorithm/splat/folded_schedule.h"

namespace sgs {

// Moves one step after the other to where it makes the lives of its sources and of its own value
// shortest together, as long as a part is free for it there. The end comes no later; steps that
// depend on what comes when it is needed stay. An early sum lets two values go for one; a late
// quotient lets none wait.
void shorten_lives(const std::vector<LaneStep>& steps, const FoldedParts& parts,
                   const OperationLatencies& latencies, FoldedSchedule& schedule);

}  // namespace sgs
