// How long a result takes through each pipeline: the end of a schedule of what its unit computes on
// the lanes that it has (modules/datapath/folded_schedule.h), at their latency.
#pragma once

#include <string>
#include <vector>

#include "algorithm/memory/record_split.h"
#include "modules/auto_choice.h"
#include "modules/datapath/lane_steps.h"
#include "modules/streaminggs/streaming_config.h"
#include "tlm/datapath.h"

namespace sgs {

// Beside a schedule: the word that it begins with is read, what it gives is written back.
constexpr std::uint32_t kReadCycles = 1, kWriteCycles = 1;

// A depth that is 0 becomes that of the pipeline and `beside` more, and is said in `chosen`, with
// the longest path that bounds it; one that is given stays. beside: cycles of what is not in the
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
