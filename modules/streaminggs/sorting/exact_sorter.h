// Sorting unit, exact order: puts the keys of one chunk in order by depth, then slot. A chunk is
// small: it always fits. Timing: one key a cycle in and out, sorting_cost.h between.
#pragma once

#include <cstdint>
#include <systemc>

#include "modules/streaminggs/messages.h"
#include "modules/streaminggs/sorting/sorting_config.h"
#include "modules/streaminggs/unit_context.h"
#include "tlm/data_sheet.h"
#include "tlm/fifo_if.h"

namespace sgs {

class ExactSorter : public sc_core::sc_module {
 public:
  FifoIns<FineCandidate> keys{"keys"};  // one a HFU; visit v comes from v modulo their number
  FifoOut<FineCandidate> sorted{"sorted"};

  SC_HAS_PROCESS(ExactSorter);
  // This unit sorts visits first_visit, first_visit + visit_step, ...
  ExactSorter(const sc_core::sc_module_name& name, const SortingNetworkConfig& config,
              std::uint32_t first_visit, std::uint32_t visit_step, const UnitContext& context);

  struct Counters : CounterSet {
    Counter visits{*this, "visits", "chunks", "sorted, once for each group"};
    Counter visits_trivial{*this, "visits_trivial", "chunks",
                           "of these with one key: in order already"};
    Counter keys{*this, "keys", "keys", "received"};
    Counter compare_exchanges{*this, "compare_exchanges", "operations", "of the sorting network"};
    Counter moves{*this, "moves", "keys", "through the sorting network, once for each pass"};
  };
  const Counters& counters() const { return counters_; }
  static SramUses sram_uses(const BuiltFor& built_for);
  void publish(DataSheet& sheet);

 private:
  void run();  // thread

  const SortingNetworkConfig config_;
  const BuiltFor built_for_;
  const std::uint32_t visit_step_;
  Activity sort_;
  Counters counters_;
  std::uint32_t visit_;
};

}  // namespace sgs
