// Counts of the filters, run once.
#include "modules/streaminggs/hfu/filter_datapaths.h"

#include <cmath>

#include "algorithm/splat/visible_extents.h"
#include "modules/datapath/counted_datapath.h"
#include "modules/datapath/filter_flows.h"

namespace sgs {
namespace {

std::uint32_t across(std::uint32_t parts) {
  return static_cast<std::uint32_t>(std::lround(std::sqrt(parts)));
}

}  // namespace

Datapath coarse_datapath(const HfuConfig& config, CoarseBoundBy bound_by, std::uint32_t parts) {
  OperationCounts in_parts = coarse_flow(bound_by, longest_case(), across(parts)).counts();
  if (bound_by == CoarseBoundBy::kExtents) in_parts.look_ups += kExtentLookUps;
  const std::uint32_t whole = folded_macs(coarse_flow(bound_by, longest_case()).counts());
  Datapath path = counted_datapath("coarse", "coarse", in_parts);
  path.lanes = config.cfu_lanes;
  path.copies = config.cfus;
  path.used_macs = config.cfu_macs + (path.counted_macs - whole);
  path.published_macs = kPaperCfuMacs;
  return path;
}

Datapath fine_datapath(const HfuConfig& config, const FineRecord& record) {
  Datapath path = counted_datapath("fine", "fine", fine_flow(longest_case(), record).all.counts());
  path.lanes = config.ffu_lanes;
  path.copies = config.ffus;
  path.used_macs = config.ffu_macs;
  path.published_macs = kPaperFfuMacs;
  return path;
}

Datapath coarse_pipeline(const HfuConfig& config, CoarseBoundBy bound_by, std::uint32_t parts,
                         const OperationLatencies& latencies) {
  Datapath path = coarse_datapath(config, bound_by, parts);
  const auto steps = coarse_flow(bound_by, longest_case(), across(parts)).steps(latencies);
  schedule(path, steps, latencies);
  set_by_group(path, steps);
  return path;
}

Datapath fine_pipeline(const HfuConfig& config, const FineRecord& record,
                       const OperationLatencies& latencies) {
  Datapath path = fine_datapath(config, record);
  const auto steps = fine_flow(longest_case(), record).all.steps(latencies);
  schedule(path, steps, latencies);
  set_by_group(path, steps);
  return path;
}

Datapath fine_pipeline(const HfuConfig& config, const FineRecord& record,
                       const OperationLatencies& latencies,
                       const std::vector<FineRecord>& records) {
  Datapath path = fine_pipeline(config, record, latencies);
  for (const FineRecord& other : records) {
    if (other == record) continue;
    HfuConfig of_other = config;
    if (config.cost == FilterCost::kCounted) {
      of_other.ffu_macs = fine_datapath(config, other).counted_macs;
    }
    path.build_also_for(fine_pipeline(of_other, other, latencies));
  }
  return path;
}

}  // namespace sgs
