// First ready, first come first served: hits on the open row overtake, until someone has waited
// longer than the age cap; from then on the bank serves its oldest request.
#pragma once

#include "modules/dram/scheduling_policy.h"

namespace sgs {

class FrFcfs : public SchedulingPolicy {
 public:
  explicit FrFcfs(std::uint64_t age_cap_cycles) : age_cap_(age_cap_cycles) {}

  std::int32_t choose(const RequestQueue& queue, std::uint32_t bank,
                      std::uint64_t cycle) const override {
    const std::int32_t oldest = queue.oldest(bank);
    const std::int32_t hit = queue.oldest_hit(bank);
    if (hit == RequestQueue::kNone || hit == oldest) return oldest;
    return queue.entry(oldest).ready + age_cap_ < cycle ? oldest : hit;
  }

  bool settled(const RequestQueue& queue, std::uint32_t bank) const override {
    const std::int32_t hit = queue.oldest_hit(bank);
    return hit == RequestQueue::kNone || hit == queue.oldest(bank);
  }

 private:
  const std::uint64_t age_cap_;
};

}  // namespace sgs
