// Merge unit, exact order: keys (depth, index) of sorted chunks wait here until nothing nearer can
// come, and are released to the fine filters in final order. When the buffer is full, the farthest
// keys go to DRAM as a sorted run and are merged back; the order stays exact.
// Timing: a pipelined heap takes or gives one key a cycle. Ties of depth are broken by the index in
// the file, which is asked for in DRAM when such a key turns up, not before.
#pragma once

#include <cstdint>
#include <deque>
#include <list>
#include <map>
#include <memory>
#include <systemc>
#include <utility>
#include <vector>

#include "modules/streaminggs/finished_groups.h"
#include "modules/streaminggs/merge/merge_config.h"
#include "modules/streaminggs/messages.h"
#include "modules/streaminggs/spill_runs.h"
#include "modules/streaminggs/unit_context.h"
#include "tlm/data_sheet.h"
#include "tlm/fifo_if.h"

namespace sgs {

// File indices of some consecutive slots, on their way from DRAM or here.
struct IndexBlock {
  std::uint32_t first_slot = 0;
  MemoryPort::Ticket ticket = 0;
  std::vector<std::uint32_t> indices;
};

// A waiting key. Its index is asked for when another key of the same depth turns up.
struct PendingKey {
  FineCandidate candidate;
  std::uint32_t index = 0;            // valid once taken from the block, or read back from a run
  std::shared_ptr<IndexBlock> block;  // null: not asked for
  bool tied = false;                  // another of its depth was released early
};

class MergeUnit : public sc_core::sc_module {
 public:
  FifoIns<FineCandidate> sorted{"sorted"};       // visit v comes from v modulo their number
  FifoOuts<FineCandidate> released{"released"};  // the keys go to them in turn
  FinishedGroupsIn finished{"finished"};
  MemoryPort memory;

  SC_HAS_PROCESS(MergeUnit);
  // spill: two areas of one run of all keys of a group each.
  MergeUnit(const sc_core::sc_module_name& name, const MergeConfig& config, const RegionSpan& spill,
            const UnitContext& context);

  struct Counters {
    std::uint64_t keys = 0;          // received
    std::uint64_t released = 0;      // in final order, to the fine filters
    std::uint64_t forced_early = 0;  // of these, before they were final (blend_early)
    std::uint64_t dropped_saturated = 0;
    std::uint64_t pending_max = 0;  // keys on chip
    std::uint64_t ties = 0;         // keys released beside others of the same depth
    std::uint64_t looked_up = 0;    // keys whose index was asked for, each once
    std::uint64_t runs_spilled = 0;
    std::uint64_t keys_spilled = 0;  // written to DRAM, over all passes
  };
  const Counters& counters() const { return counters_; }
  static SramUses sram_uses(const MergeConfig& config, const BuiltFor& built_for);
  void publish(DataSheet& sheet);

 private:
  struct KeyCodec {
    using Entry = PendingKey;
    static constexpr std::uint32_t kBytes = kSpilledKeyBytes;
    std::uint32_t group = 0;
    void encode(const PendingKey& key, std::byte* out) const;
    PendingKey decode(const std::byte* bytes) const;
  };
  using RunReader = SpillReader<KeyCodec>;

  void run();  // thread
  void insert(const FineCandidate& key);
  void ask_for_ties();
  void ask_for(PendingKey& key, std::uint32_t first_slot, std::uint32_t slots);
  void release_below(float nearest);
  void release_depth(float depth);
  void force_out();
  void emit(const PendingKey& key);
  void end_group(const FineCandidate& end);
  void look_up(std::vector<PendingKey>& keys);
  void spill_farthest();
  void merge_shortest_runs();
  void merge_runs(std::list<RunReader>::iterator end);
  void keep_run(const SpillPort& to, const SpillRun& run);
  bool fits_spill_area(std::uint64_t keys) const;
  static RunReader* nearest_of(std::list<RunReader>& runs);
  static void take_front(RunReader& run, std::list<RunReader>& from);
  std::uint64_t spill_area_base() const { return spill_.base + spill_area_ * (spill_.bytes / 2); }
  SpillPort spill_port() { return {memory, merge_, config_.spill_block_entries, spill_.region}; }
  void drop_all();

  const MergeConfig config_;
  const BuiltFor built_for_;
  const StreamingJob& job_;
  const RegionSpan spill_;
  Activity merge_;
  std::map<float, std::vector<PendingKey>> pending_;      // by depth; ties together
  std::vector<std::pair<float, std::uint32_t>> arrived_;  // (depth, slot) of this visit's keys
  std::list<RunReader> runs_;                             // none of them exhausted
  std::uint32_t spill_area_ = 0;                          // which half new runs go to
  std::uint64_t spill_used_ = 0;                          // bytes of it
  std::uint32_t spills_ = 0;                              // of this group
  // Blocks asked for: they outlive keys that a finished group drops.
  std::deque<std::shared_ptr<IndexBlock>> in_flight_;
  std::uint64_t sequence_ = 0;                   // keys and marks released
  std::uint32_t group_ = 0, pending_count_ = 0;  // for the waveform
  Counters counters_;
};

}  // namespace sgs
