// Counts of the filters, run once.
#include "modules/streaminggs/hfu/filter_datapaths.h"

#include <algorithm>
#include <cmath>

#include "algorithm/splat/visible_extents.h"
#include "modules/datapath/counted_datapath.h"
#include "modules/datapath/filter_flows.h"
#include "modules/datapath/work_rates.h"

namespace sgs {
namespace {

// The configuration for records of another degree, where tests cost what is counted.
HfuConfig for_record(HfuConfig config, const FineRecord& record) {
  if (config.cost == FilterCost::kCounted) {
    config.ffu_macs = fine_datapath(config, record).counted_macs;
  }
  return config;
}

}  // namespace

std::uint32_t parts_across(std::size_t parts) {
  return static_cast<std::uint32_t>(std::lround(std::sqrt(parts)));
}

Datapath coarse_datapath(const HfuConfig& config, CoarseBoundBy bound_by, std::uint32_t parts) {
  OperationCounts in_parts =
      coarse_flow(bound_by, longest_case(config.eyes), parts_across(parts)).counts();
  if (bound_by == CoarseBoundBy::kExtents) in_parts.look_ups += kExtentLookUps;
  const std::uint32_t whole =
      folded_macs(coarse_flow(bound_by, longest_case(config.eyes)).counts());
  Datapath path = counted_datapath("coarse", "coarse", in_parts);
  path.lanes = config.cfu_lanes;
  path.copies = config.cfus;
  path.used_macs = config.cfu_macs + (path.counted_macs - whole);
  path.published_macs = kPaperCfuMacs;
  return path;
}

Datapath fine_datapath(const HfuConfig& config, const FineRecord& record) {
  Datapath path =
      counted_datapath("fine", "fine", fine_flow(longest_case(config.eyes), record).all.counts());
  path.lanes = config.ffu_lanes;
  path.copies = config.ffus;
  path.used_macs = config.ffu_macs;
  path.published_macs = kPaperFfuMacs;
  return path;
}

Datapath coarse_pipeline(const HfuConfig& config, CoarseBoundBy bound_by, std::uint32_t parts,
                         const OperationLatencies& latencies) {
  Datapath path = coarse_datapath(config, bound_by, parts);
  const auto steps =
      coarse_flow(bound_by, longest_case(config.eyes), parts_across(parts)).steps(latencies);
  schedule(path, steps, latencies);
  set_by_group(path, steps);
  return path;
}

Datapath fine_pipeline(const HfuConfig& config, const FineRecord& record,
                       const OperationLatencies& latencies) {
  Datapath path = fine_datapath(config, record);
  const auto steps = fine_flow(longest_case(config.eyes), record).all.steps(latencies);
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
    path.build_also_for(fine_pipeline(for_record(config, other), other, latencies));
  }
  return path;
}

Datapath rounding_pipeline(const HfuConfig& config, const OperationLatencies& latencies) {
  constexpr FineRecord kLeast{0, 4};
  const std::uint64_t turn =
      fine_datapath(for_record(config, kLeast), kLeast).interval_cycles() / config.ffus;
  const FlowPart flow = rounding_flow();
  Datapath path = counted_datapath("rounding", "fine", flow.counts());
  path.lanes =
      static_cast<std::uint32_t>(cycles_for(path.used_macs, std::max<std::uint64_t>(1, turn)));
  schedule(path, flow.steps(latencies), latencies);
  return path;
}

}  // namespace sgs
