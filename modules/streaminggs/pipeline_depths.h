// Latency of a result through each pipeline: the end of its unit's schedule
// (modules/datapath/folded_schedule.h) on the lanes that the unit has.
#pragma once

#include <string>
#include <vector>

#include "algorithm/memory/record_split.h"
#include "modules/auto_choice.h"
#include "modules/datapath/lane_steps.h"
#include "modules/streaminggs/streaming_config.h"
#include "tlm/datapath.h"

namespace sgs {

// Cycles beside a schedule: its first word is read, its result is written back.
constexpr std::uint32_t kReadCycles = 1, kWriteCycles = 1;

// Fills in a depth that is 0: the pipeline's depth and `beside` more, listed in `chosen` with the
// longest path that bounds it. A depth that is given stays. beside: cycles that are not in the
// schedule, as reading and writing. Throws InputError for one that is less than that.
void resolve_depth(const char* key, std::uint32_t& depth_cycles, const Datapath& pipeline,
                   const LongestPath& path, const OperationLatencies& latencies,
                   std::uint32_t beside, std::vector<AutoChoice>& chosen);

// Depths of rendering; the sizes that its memories allow depend on them. Throws likewise.
void resolve_rendering_depths(StreamingConfig& config, std::vector<AutoChoice>& chosen);
// Depths of the filters, on records of this split and SH degree; each reads its record first, a
// word a cycle. Throws likewise.
void resolve_filter_depths(StreamingConfig& config, const RecordSplit& split, int sh_degree,
                           std::vector<AutoChoice>& chosen);

}  // namespace sgs
