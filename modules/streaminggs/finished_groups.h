// Rendering's feedback: "this group is finished, nothing can change it any more". It travels: who
// asks sees it `latency` cycles after it was known, and drops what is left of the group.
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <systemc>
#include <vector>

#include "tlm/clock_domain.h"

namespace sgs {

class FinishedGroupsIf : public virtual sc_core::sc_interface {
 public:
  virtual bool finished(std::uint32_t group) const = 0;
};

class FinishGroupIf : public virtual sc_core::sc_interface {
 public:
  // known_in_cycles: from now on, until the speaker's own pipeline has the news.
  virtual void finish(std::uint32_t group, std::uint32_t known_in_cycles) = 0;
};

class FinishedGroups : public sc_core::sc_prim_channel,
                       public FinishedGroupsIf,
                       public FinishGroupIf {
 public:
  // latency_cycles: at least 1, so that what units see does not depend on which of them the kernel
  // runs first.
  FinishedGroups(const char* name, const ClockDomain& clock, std::size_t groups,
                 std::uint32_t latency_cycles)
      : sc_prim_channel(name),
        period_(clock.period()),
        latency_cycles_(latency_cycles),
        seen_from_(groups, sc_core::sc_max_time()) {}

  void finish(std::uint32_t group, std::uint32_t known_in_cycles) override {
    sc_core::sc_time& from = seen_from_[group];
    if (from != sc_core::sc_max_time()) return;
    const double cycles = static_cast<double>(known_in_cycles) + latency_cycles_;
    from = sc_core::sc_time_stamp() + cycles * period_;
  }
  bool finished(std::uint32_t group) const override {
    return seen_from_[group] <= sc_core::sc_time_stamp();
  }

  const char* kind() const override { return "sgs::FinishedGroups"; }

 private:
  const sc_core::sc_time period_;
  const std::uint32_t latency_cycles_;
  std::vector<sc_core::sc_time> seen_from_;  // [group]
};

using FinishedGroupsIn = sc_core::sc_port<FinishedGroupsIf>;
// One for each part of the groups, in their order.
using FinishedGroupsIns = sc_core::sc_port<FinishedGroupsIf, 0>;
using FinishGroupOut = sc_core::sc_port<FinishGroupIf>;

// Number of parts in a set of them, a bit each.
inline std::uint32_t count_parts(std::uint32_t parts) {
  return static_cast<std::uint32_t>(std::bitset<32>(parts).count());
}

// Parts of the group that are not finished, a bit each.
inline std::uint32_t unfinished_parts(FinishedGroupsIns& parts, std::uint32_t group) {
  std::uint32_t open = 0;
  for (int p = 0; p < parts.size(); ++p) open |= parts[p]->finished(group) ? 0U : 1U << p;
  return open;
}

// All parts of the group are finished.
inline bool all_finished(FinishedGroupsIns& parts, std::uint32_t group) {
  return unfinished_parts(parts, group) == 0;
}

}  // namespace sgs
