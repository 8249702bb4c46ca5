// Dispatcher, queues and clusters of the rendering unit stepped cycle by cycle: what the schedule
// of modules/streaminggs/rendering computes ahead, done as hardware does it.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "algorithm/render/group_state.h"
#include "modules/streaminggs/rendering/rendering_config.h"

namespace sgs::tb {

// What the unit takes out of its FIFOs, in order: a splat with what it reaches, or a mark.
struct RenderingToken {
  bool is_splat = false;
  std::uint32_t rows = 0, spans = 0;
  std::vector<std::size_t> footprint;  // places of its sub-tiles in the group
  std::vector<SubtileReach> reaches;
};

struct RenderingTimes {
  std::uint64_t cycles = 0;  // from the first token until every cluster is free again
  std::optional<std::uint64_t>
      finished;  // every sub-tile is known to be finished from this cycle on
  std::uint64_t blends = 0, late_blends = 0, hazard_cycles = 0, queue_cycles = 0;
  std::uint64_t spans = 0, splats_spanned = 0, begun_span_reads = 0;
  std::uint64_t rows = 0, row_cycles = 0;
  std::uint64_t splats_hidden = 0;  // came when their whole footprint was finished
  std::uint64_t subtiles_finished = 0;
  std::uint64_t splats_dropped = 0;  // came when that was known
};

// One group of so many sub-tiles that begins in cycle `from`, its tokens there when they are asked
// for. Times are from then on.
RenderingTimes step_rendering(const RenderingConfig& config, std::size_t subtiles,
                              const std::vector<RenderingToken>& tokens, std::uint64_t from);

}  // namespace sgs::tb
