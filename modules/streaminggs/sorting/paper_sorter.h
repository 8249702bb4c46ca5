// Sorting unit, paper order: puts the splats of one visit in order, front to back, equal depths by
// index. Timing: one entry a cycle in and out, sorting_cost.h between, where the lists that share
// the network have turns. A visit with more splats than the buffer holds spills sorted runs to DRAM
// and merges them back, in several passes if need be.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <systemc>
#include <vector>

#include "algorithm/memory/splat_record.h"
#include "modules/streaminggs/finished_groups.h"
#include "modules/streaminggs/messages.h"
#include "modules/streaminggs/sorting/sorting_config.h"
#include "modules/streaminggs/spill_runs.h"
#include "modules/streaminggs/unit_context.h"
#include "tlm/data_sheet.h"
#include "tlm/fifo_selector.h"

namespace sgs {

// Visits that a unit sorts, of its part of the groups: first_visit, first_visit + visit_step, ...
// Its part of the spill region holds two copies of the longest list.
struct PaperSorterPlace {
  std::uint32_t first_visit, visit_step;
  RegionSpan spill;
  std::uint32_t lists_of_network = 1;  // lists that its sorting network serves in turn
};

class PaperSorter : public sc_core::sc_module {
 public:
  FifoIns<SplatToken> splats{"splats"};  // one a HFU
  FifoOut<SplatToken> sorted{"sorted"};
  FinishedGroupsIn finished{"finished"};
  MemoryPort memory;

  SC_HAS_PROCESS(PaperSorter);
  PaperSorter(const sc_core::sc_module_name& name, const PaperSorterConfig& config,
              const PaperSorterPlace& place, const UnitContext& context);

  struct Counters : CounterSet {
    Counter visits{*this, "visits", "voxels", "sorted, once for each group"};
    Counter visits_trivial{*this, "visits_trivial", "voxels",
                           "of these with one splat: in order already"};
    Counter splats{*this, "splats", "splats", "received"};
    Counter splats_saturated{*this, "splats_saturated", "splats",
                             "dropped: their group was finished"};
    Counter compare_exchanges{*this, "compare_exchanges", "operations", "of the sorting network"};
    Counter moves{*this, "moves", "keys", "through the sorting network, once for each pass"};
    Counter runs_spilled{*this, "runs_spilled", "runs", "written to DRAM"};
    Counter entries_spilled{*this, "entries_spilled", "splats", "written to DRAM, over all passes"};
    Counter list_max{*this, "list_max", "splats", "longest list of one visit"};
  };
  const Counters& counters() const { return counters_; }
  static SramUses sram_uses(const PaperSorterConfig& config, const BuiltFor& built_for);
  void publish(DataSheet& sheet);

 private:
  // A splat in the sort buffer: what it is sorted by, and its bytes.
  struct Entry {
    float depth = 0;
    std::uint32_t index = 0;
    std::array<std::byte, kSplatEntryBytes> bytes{};
  };
  static bool in_front(const Entry& a, const Entry& b) {
    return a.depth < b.depth || (a.depth == b.depth && a.index < b.index);
  }
  struct Codec;

  void run();  // thread
  SplatToken collect(FifoSelector<SplatToken>& inputs);
  void accept(const SplatToken& token);
  void sort_buffer();
  void spill_buffer();
  void merge_runs();
  template <class Sink>
  void merge(const SpillRun* runs, std::size_t count, Sink&& sink);
  void emit(const Entry& entry);
  std::uint32_t entry_bytes() const { return splat_entry_bytes(built_for_.splats); }
  SubtileRect group_subtiles() const;
  SpillPort spill_port() {
    return {memory, sort_, config_.spill_block_entries, place_.spill.region};
  }

  const PaperSorterConfig config_;
  const BuiltFor built_for_;
  const PaperSorterPlace place_;
  const StreamingJob& job_;
  Activity sort_;
  std::vector<Entry> buffer_;
  std::vector<SpillRun> runs_;
  std::uint64_t spill_used_ = 0;
  std::uint32_t group_ = 0, visit_ = 0;
  std::uint64_t received_ = 0, emitted_ = 0;  // splats of this visit
  Counters counters_;
};

}  // namespace sgs
