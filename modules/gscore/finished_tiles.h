// Rendering's feedback to the sorter of its core: "this tile is finished, nothing can change it any
// more". Who asks sees it `latency` cycles after it was known.
#pragma once

#include <cstddef>
#include <cstdint>
#include <systemc>
#include <vector>

#include "tlm/clock_domain.h"

namespace sgs::gscore {

class FinishedTiles : public sc_core::sc_object {
 public:
  // latency_cycles: at least 1, so that what is seen does not depend on which unit the kernel runs
  // first.
  FinishedTiles(const char* name, const ClockDomain& clock, std::size_t tiles,
                std::uint32_t latency_cycles)
      : sc_object(name),
        period_(clock.period()),
        latency_cycles_(latency_cycles),
        seen_from_(tiles, sc_core::sc_max_time()) {}

  // known_from: the cycle from which on the speaker's own pipeline has the news. It may be said
  // again.
  void finish(std::uint32_t tile, std::uint64_t known_from) {
    seen_from_[tile] =
        sc_core::sc_time::from_value((known_from + latency_cycles_) * period_.value());
  }
  bool finished(std::uint32_t tile) const { return seen_from_[tile] <= sc_core::sc_time_stamp(); }

 private:
  const sc_core::sc_time period_;
  const std::uint32_t latency_cycles_;
  std::vector<sc_core::sc_time> seen_from_;  // [tile]
};

}  // namespace sgs::gscore
