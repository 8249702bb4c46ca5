// Schedule, then lives, then wiring.
#include "algorithm/splat/folded_pipeline.h"

#include "algorithm/splat/shorter_lives.h"

namespace sgs {

FoldedPipeline folded_pipeline(const std::vector<LaneStep>& steps, const FoldedParts& parts,
                               const OperationLatencies& latencies) {
  FoldedPipeline out;
  out.parts = at_least(parts, steps);
  out.schedule = folded_schedule(steps, out.parts, latencies);
  shorten_lives(steps, out.parts, latencies, out.schedule);
  out.wiring = lane_wiring(steps, out.schedule, out.parts, latencies);
  return out;
}

}  // namespace sgs
