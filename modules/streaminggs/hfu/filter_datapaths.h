// The lanes of the coarse and of the fine filter of one HFU, and the operations of a test on them.
#pragma once

#include <cstddef>
#include <vector>

#include "algorithm/memory/record_split.h"
#include "algorithm/splat/coarse_bound.h"
#include "modules/datapath/lane_steps.h"
#include "modules/streaminggs/hfu/hfu_config.h"
#include "tlm/datapath.h"

namespace sgs {

// True if there are CFUs. A machine of exact order has them whether they filter or not: they
// compute the depth that is a Gaussian's key.
inline bool has_cfus(const HfuConfig& config, CoarseBoundBy bound_by) {
  return config.coarse_filter || bound_by == CoarseBoundBy::kExtents;
}

// Columns, and rows, of so many parts.
std::uint32_t parts_across(std::size_t parts);

// parts: of a group that one test tells apart, a square number. cfu_macs are of a group in one.
Datapath coarse_datapath(const HfuConfig& config, CoarseBoundBy bound_by, std::uint32_t parts);
Datapath fine_datapath(const HfuConfig& config, const FineRecord& record);

// The same datapaths, scheduled on lanes of such latencies.
Datapath coarse_pipeline(const HfuConfig& config, CoarseBoundBy bound_by, std::uint32_t parts,
                         const OperationLatencies& latencies);
Datapath fine_pipeline(const HfuConfig& config, const FineRecord& record,
                       const OperationLatencies& latencies);
// For a machine that takes any of `records`, each by its own schedule: registers and comparators of
// the one that needs most. Multiplexers likewise, as if the schedules chose alike where they can.
Datapath fine_pipeline(const HfuConfig& config, const FineRecord& record,
                       const OperationLatencies& latencies, const std::vector<FineRecord>& records);

// Rounding of an HFU's splats to halves, on as many lanes as keep pace with its FFUs, whatever the
// record.
Datapath rounding_pipeline(const HfuConfig& config, const OperationLatencies& latencies);

// The datapath of several HFUs.
inline Datapath side_by_side(Datapath of_one, std::uint32_t hfus) {
  of_one.copies *= hfus;
  return of_one;
}

}  // namespace sgs
