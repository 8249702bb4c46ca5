// Places reserved in the FIFO behind a pipeline that drops some items. An item begins only where
// there is a place for it, since its result is not known yet. One that fails gives its place back
// when it leaves the pipeline. One that passes counts as an entry of the FIFO from its beginning
// on.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>

#include "tlm/fifo_if.h"

namespace sgs {

class PlacesUnderTest {
 public:
  // depth_cycles: of the pipeline, which is the FIFO's latency.
  explicit PlacesUnderTest(std::uint32_t depth_cycles) : depth_cycles_(depth_cycles) {}

  // It began in cycle `begin`, and will not pass.
  void add(std::uint64_t begin) { left_in_.push_back(begin + 1 + depth_cycles_); }
  // Places that are taken in cycle `now`, which does not go back.
  std::uint32_t taken(std::uint64_t now) {
    while (!left_in_.empty() && left_in_.front() <= now) left_in_.pop_front();
    return static_cast<std::uint32_t>(left_in_.size());
  }
  // Blocks until there is a place for one more in `to`, or until a cycle: false.
  template <class T>
  bool wait_for_one(FifoWriteIf<T>& to, Activity& activity,
                    std::uint64_t until = FifoWriteIf<T>::kNever) {
    for (;;) {
      const std::uint64_t now = activity.clock().now_cycles();
      const std::uint32_t besides = taken(now);
      if (to.room() > besides) return true;
      if (now >= until) return false;
      to.wait_for_room(besides + 1, besides > 0 ? std::min(left_in_.front(), until) : until,
                       activity);
    }
  }

 private:
  std::uint32_t depth_cycles_;
  std::deque<std::uint64_t> left_in_;  // cycle in which each leaves the pipeline
};

}  // namespace sgs
