// Policy that chooses which request of a bank is served next. One policy a file; see fr_fcfs.h and
// fcfs.h.
#pragma once

#include <cstdint>
#include <memory>

#include "modules/dram/dram_config.h"
#include "modules/dram/request_queue.h"

namespace sgs {

class SchedulingPolicy {
 public:
  virtual ~SchedulingPolicy() = default;

  // The request that `bank` (which has some) should serve at `cycle`, or RequestQueue::kNone to let
  // it rest.
  virtual std::int32_t choose(const RequestQueue& queue, std::uint32_t bank,
                              std::uint64_t cycle) const = 0;

  // True if the bank's choice stays the same until its requests or its open row change.
  virtual bool settled(const RequestQueue& queue, std::uint32_t bank) const = 0;
};

std::unique_ptr<SchedulingPolicy> make_scheduling_policy(const DramConfig& config);

}  // namespace sgs
