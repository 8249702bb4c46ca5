// Groups that a bench reports to its units as finished, and when they see it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "modules/streaminggs/finished_groups.h"
#include "testbench/units/case_runner.h"

namespace sgs::tb {

class ReportedGroups {
 public:
  ReportedGroups(const ClockDomain& clock, std::size_t groups, std::uint32_t latency_cycles)
      : channel("finished_groups", clock, groups, latency_cycles),
        clock_(clock),
        latency_cycles_(latency_cycles),
        seen_from_(groups, std::numeric_limits<std::uint64_t>::max()) {}

  FinishedGroups channel;

  void finish(std::uint32_t group) {
    channel.finish(group, 0);
    seen_from_[group] = std::min(seen_from_[group], clock_.now_cycles() + latency_cycles_);
  }
  // As units see it now.
  bool finished(std::uint32_t group) const { return channel.finished(group); }
  // The first cycle in which units see it; not reported: later than any.
  std::uint64_t seen_from(std::uint32_t group) const { return seen_from_[group]; }

 private:
  const ClockDomain& clock_;
  const std::uint32_t latency_cycles_;
  std::vector<std::uint64_t> seen_from_;  // [group]
};

// Checks a unit that hands out visits. After each visit it goes on with the group. From the cycle
// on in which it sees that the group is finished, it leaves the rest out. cycles: in which the
// visits came out of a FIFO with a latency of one cycle and without stalls; all: how many there
// would be.
inline void check_feedback(Checks& checks, const ReportedGroups& groups, std::uint32_t group,
                           const std::vector<std::uint64_t>& cycles, std::size_t all) {
  for (std::size_t k = 1; k < cycles.size(); ++k) {
    checks.that(cycles[k - 1] - 1 < groups.seen_from(group),
                fmt::format("group {}: visit {} although the group is finished", group, k));
  }
  if (cycles.empty() || cycles.size() == all) return;
  checks.that(cycles.back() - 1 >= groups.seen_from(group),
              fmt::format("group {}: the rest is left out too soon", group));
}

}  // namespace sgs::tb
