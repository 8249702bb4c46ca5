// A computation on the lanes that a unit has for it: when its steps are done and what stands
// between the lanes.
#pragma once

#include <vector>

#include "algorithm/splat/folded_schedule.h"
#include "algorithm/splat/lane_wiring.h"

namespace sgs {

struct FoldedPipeline {
  FoldedParts parts;
  FoldedSchedule schedule;
  LaneWiring wiring;
};

// On these parts, or on as many as the steps take at this interval if that is more: so where a
// machine charges less than was counted.
FoldedPipeline folded_pipeline(const std::vector<LaneStep>& steps, const FoldedParts& parts,
                               const OperationLatencies& latencies);

}  // namespace sgs
