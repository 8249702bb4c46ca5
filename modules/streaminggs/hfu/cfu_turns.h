// When the CFUs of a coarse filter take their Gaussians: one each in their turns, a cycle after
// each other as these come out of the input buffer; so they are done a cycle apart. Without CFUs a
// Gaussian takes that cycle.
#pragma once

#include <cstdint>

#include "modules/datapath/work_rates.h"
#include "tlm/datapath.h"

namespace sgs {

class CfuTurns {
 public:
  CfuTurns(const Datapath& tests, bool has_cfus)
      : cfus_(has_cfus ? tests.copies : 1),
        interval_(cycles_for(cfus_, has_cfus ? tests.interval_cycles() : 1) *
                  (has_cfus ? tests.interval_cycles() : 1)) {}

  // The cycle behind that in which the next one is taken.
  std::uint64_t next(std::uint64_t cycle) const {
    return next_turn_of_one(cycle, interval_, cfus_) + 1;
  }

 private:
  const std::uint64_t cfus_, interval_;
};

}  // namespace sgs
