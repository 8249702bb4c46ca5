// Merge unit, exact order: keys (depth, slot) of sorted chunks wait here until nothing nearer can
// come, and are released to the fine filters in final order. When the buffer is full, the farthest
// keys go to DRAM as a sorted run and are merged back; the order stays exact. A key that is due and
// reaches finished sub-tiles only is dropped: its second half is never fetched. Of two eyes those
// whose sub-tiles are finished do not get it.
// Keys wait in an interval heap, which gives its nearest and its farthest key.
// Timing: a key in or out and a mark take a cycle each. The heap begins an insert or delete every
// `cycles_per_operation` cycles; all else passes beside it. `latency_cycles` pass in the FIFO ahead
// (exact_config.cpp). Area and energy: merge_unit_sheet.cpp.
#pragma once

#include <cstdint>
#include <list>
#include <systemc>

#include "algorithm/order/interval_heap.h"
#include "modules/streaminggs/finished_groups.h"
#include "modules/streaminggs/finished_subtiles.h"
#include "modules/streaminggs/merge/merge_config.h"
#include "modules/streaminggs/messages.h"
#include "modules/streaminggs/nearer_key.h"
#include "modules/streaminggs/spill_runs.h"
#include "modules/streaminggs/unit_context.h"
#include "tlm/data_sheet.h"
#include "tlm/fifo_if.h"

namespace sgs {

class MergeUnit : public sc_core::sc_module {
 public:
  FifoIns<FineCandidate> sorted{"sorted"};       // visit v comes from v modulo their number
  FifoOuts<FineCandidate> released{"released"};  // the keys go to them in turn
  FinishedGroupsIns finished{"finished"};        // one an eye
  FinishedSubtilesIns masks{"masks"};            // likewise
  MemoryPort memory;

  SC_HAS_PROCESS(MergeUnit);
  // spill: two areas of one run of all keys of a group each.
  MergeUnit(const sc_core::sc_module_name& name, const MergeConfig& config, const RegionSpan& spill,
            const UnitContext& context);

  struct Counters : CounterSet {
    Counter keys{*this, "keys", "keys", "received"};
    Counter released{*this, "released", "keys", "in final order, to the fine filters"};
    Counter ties{*this, "ties", "keys", "of these at the depth of the key before: ordered by slot"};
    Counter forced_early{*this, "forced_early", "keys", "of these before they were final"};
    Counter due{*this, "due", "keys", "looked up in the mask of finished sub-tiles"};
    Counter dropped_hidden{
        *this, "dropped_hidden", "keys",
        "dropped when they were due: all sub-tiles that they reach were finished"};
    Counter dropped_saturated{*this, "dropped_saturated", "keys",
                              "dropped: their group was finished"};
    Counter pending_keys_max{*this, "pending_keys_max", "keys", "most that waited on chip"};
    Counter runs_spilled{*this, "runs_spilled", "runs", "written to DRAM"};
    Counter keys_spilled{*this, "keys_spilled", "keys", "written to DRAM, over all passes"};
  };
  const Counters& counters() const { return counters_; }
  static constexpr std::uint32_t kSlotBits = 30;  // of its word in a spilled key, the eyes above
  const HeapWork& heap_work() const { return pending_.work(); }
  static SramUses sram_uses(const MergeConfig& config, const BuiltFor& built_for);
  void publish(DataSheet& sheet);

 private:
  struct KeyCodec {
    using Entry = FineCandidate;
    std::uint32_t group = 0;
    static constexpr std::uint32_t bytes() { return kKeyBytes; }
    void encode(const FineCandidate& key, std::byte* out) const;
    FineCandidate decode(const std::byte* bytes) const;
  };
  using RunReader = SpillReader<KeyCodec>;

  // Keys that the heap must hold. With blend_early nothing leaves it before the visit has come to
  // its end, whose chunk it needs room for.
  static std::uint32_t heap_entries(const MergeConfig& config, const BuiltFor& built_for);

  void run();  // thread
  void take(const FineCandidate& key);
  void release_below(float nearest);
  void force_out();
  void emit(const FineCandidate& key);
  void end_group(const FineCandidate& end);
  void wait_for_heap();
  FineCandidate take_nearest();
  void spill_farthest();
  void merge_shortest_runs();
  void merge_runs(std::list<RunReader>::iterator end);
  void keep_run(const SpillPort& to, const SpillRun& run);
  bool fits_spill_area(std::uint64_t keys) const;
  static RunReader* nearest_of(std::list<RunReader>& runs);
  static void take_front(RunReader& run, std::list<RunReader>& from);
  std::uint64_t next_run_address() const {
    return spill_.base + spill_area_ * (spill_.bytes / 2) + spill_used_;
  }
  SpillPort spill_port() { return {memory, merge_, config_.spill_block_entries, spill_.region}; }
  void drop_all();
  void publish_ledger(DataSheet& sheet);
  void note_pending() { pending_count_ = static_cast<std::uint32_t>(pending_.size()); }

  const MergeConfig config_;
  const BuiltFor built_for_;
  const RegionSpan spill_;
  Activity merge_;
  IntervalHeap<FineCandidate, NearerKey> pending_;
  std::list<RunReader> runs_;                    // none of them exhausted
  std::uint32_t spill_area_ = 0;                 // which half new runs go to
  std::uint64_t spill_used_ = 0;                 // bytes of it
  std::uint32_t spills_ = 0;                     // spills of this group so far
  std::uint64_t sequence_ = 0;                   // keys and marks released
  std::uint64_t heap_free_ = 0;                  // cycle from which on it begins another operation
  float last_depth_ = -1;                        // depth of the key released last in this group
  std::uint32_t group_ = 0, pending_count_ = 0;  // for the waveform
  Counters counters_;
};

}  // namespace sgs
