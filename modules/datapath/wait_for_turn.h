// Waiting for a pipeline that begins an item only in its turn.
#pragma once

#include <cstdint>

#include "modules/datapath/work_rates.h"
#include "tlm/activity.h"

namespace sgs {

// Until the pipeline's next turn. It keeps the activity busy, and what waits keeps its place in the
// queue ahead: take it out behind this.
inline void wait_for_turn(Activity& activity, std::uint64_t interval) {
  const std::uint64_t now = activity.clock().now_cycles();
  activity.work(next_turn(now, interval) - now);
}

}  // namespace sgs
