// First come, first served: only the oldest request of the queue has commands.
#pragma once

#include "modules/dram/scheduling_policy.h"

namespace sgs {

class Fcfs : public SchedulingPolicy {
 public:
  std::int32_t choose(const RequestQueue& queue, std::uint32_t bank, std::uint64_t) const override {
    const std::int32_t oldest = queue.oldest(bank);
    return queue.entry(oldest).order == queue.oldest_order() ? oldest : RequestQueue::kNone;
  }

  bool settled(const RequestQueue&, std::uint32_t) const override { return false; }
};

}  // namespace sgs
