// From counts to cycles: rules that several units share.
#pragma once

#include <cstdint>

#include "tlm/activity.h"

namespace sgs {

// Cycles of `count` things of which `per_cycle` are done a cycle.
constexpr std::uint64_t cycles_for(std::uint64_t count, std::uint64_t per_cycle) {
  return (count + per_cycle - 1) / per_cycle;
}

// The first cycle from `now` on in which an item may begin: a multiple of the interval. A fixed
// schedule begins items only in these turns, or two of them would want the same parts at once.
constexpr std::uint64_t next_turn(std::uint64_t now, std::uint64_t interval) {
  return cycles_for(now, interval) * interval;
}

// The next turn of any of `copies`, whose turns follow each other by a cycle, the first in cycle 0.
// As many as the interval has cycles begin an item each cycle; more than these never have a turn.
constexpr std::uint64_t next_turn_of_one(std::uint64_t now, std::uint64_t interval,
                                         std::uint64_t copies) {
  return now % interval < copies ? now : next_turn(now, interval);
}

// Likewise where turns are spread evenly over the interval: what each begins with comes apart, too.
constexpr std::uint64_t next_spread_turn(std::uint64_t now, std::uint64_t interval,
                                         std::uint64_t copies) {
  if (now == 0 || copies >= interval) return now;
  const std::uint64_t turn = (now - 1) * copies / interval + 1;
  return cycles_for(turn * interval, copies);
}

// Waits until the pipeline's next turn. It keeps the activity busy, and what waits keeps its place
// in the queue ahead: take it out behind this.
inline void wait_for_turn(Activity& activity, std::uint64_t interval) {
  const std::uint64_t now = activity.clock().now_cycles();
  activity.work(next_turn(now, interval) - now);
}

}  // namespace sgs
