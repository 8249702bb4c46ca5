// Sorting unit, exact order: puts the keys of one chunk in order by depth, then slot. A chunk is
// small: it always fits. Timing: one key a cycle in and out, sorting_cost.h between.
#pragma once

#include <cstdint>
#include <systemc>
#include <vector>

#include "modules/messages.h"
#include "modules/saturation_board.h"
#include "modules/sorting/sorting_config.h"
#include "tlm/timed_fifo.h"

namespace sgs {

struct KeySorterCounters {
  std::uint64_t visits = 0;
  std::uint64_t visits_trivial = 0;  // 0 or 1 keys: nothing to sort
  std::uint64_t keys = 0;
  std::uint64_t compare_exchanges = 0;
};

class KeySorter : public sc_core::sc_module {
 public:
  SC_HAS_PROCESS(KeySorter);
  // This unit sorts visits first_visit, first_visit + visit_step, ...; visit v comes from inputs
  // v modulo their number (one FIFO a HFU).
  KeySorter(const sc_core::sc_module_name& name, const SortingConfig& config,
            std::uint32_t first_visit, std::uint32_t visit_step, const ClockDomain& clock,
            std::vector<TimedFifo<FineCandidate>*> inputs, TimedFifo<FineCandidate>& output);

  const KeySorterCounters& counters() const { return counters_; }
  Activity& activity() { return activity_; }
  const Activity& activity() const { return activity_; }
  void trace(sc_core::sc_trace_file* file) const;

 private:
  void run();  // thread

  const SortingConfig config_;
  const std::uint32_t visit_step_;
  std::vector<TimedFifo<FineCandidate>*> inputs_;
  TimedFifo<FineCandidate>& output_;
  Activity activity_;
  KeySorterCounters counters_;
  std::uint32_t visit_;
};

}  // namespace sgs
