// Sorting unit: puts the splats of one visit in order, front to back, equal depths by index.
// Timing: one entry a cycle in and out, sorting_cost.h between. A visit with more splats than the
// buffer holds spills sorted runs to DRAM and merges them back, in several passes if need be.
#pragma once

#include <cstdint>
#include <systemc>
#include <vector>

#include "modules/frame_job.h"
#include "modules/messages.h"
#include "modules/saturation_board.h"
#include "modules/sorting/sorting_config.h"
#include "modules/spill_runs.h"
#include "tlm/fifo_selector.h"

namespace sgs {

struct SortingCounters {
  std::uint64_t visits = 0;
  std::uint64_t visits_trivial = 0;    // 0 or 1 splats: nothing to sort
  std::uint64_t splats = 0;            // received
  std::uint64_t splats_saturated = 0;  // dropped: the group was finished
  std::uint64_t compare_exchanges = 0;
  std::uint64_t runs_spilled = 0;
  std::uint64_t entries_spilled = 0;  // written to DRAM, over all passes
  std::uint64_t list_max = 0;         // longest list of one visit
};

class SortingUnit : public sc_core::sc_module {
 public:
  SC_HAS_PROCESS(SortingUnit);
  // first_visit, visit_step: this unit sorts visits first_visit, first_visit + visit_step, ...
  // inputs: one FIFO a HFU. spill: this unit's part of the spill region; it holds two copies of the
  // longest list.
  struct Place {
    std::uint32_t first_visit, visit_step;
    std::uint64_t spill_base, spill_bytes;
  };
  SortingUnit(const sc_core::sc_module_name& name, const SortingConfig& config, const Place& place,
              const ClockDomain& clock, const FrameJob& job, const SaturationBoard& board,
              MemoryPort& port, std::vector<TimedFifo<SplatToken>*> inputs,
              TimedFifo<SplatToken>& output);

  const SortingCounters& counters() const { return counters_; }
  Activity& activity() { return activity_; }
  void trace(sc_core::sc_trace_file* file) const;

 private:
  void run();  // thread
  SplatToken collect();
  void accept(const SplatToken& token);
  void sort_buffer();
  void spill_buffer();
  void merge_runs();
  template <class Sink>
  void merge(const SpillRun* runs, std::size_t count, Sink&& sink);
  void emit(const Splat& splat);
  SubtileRect group_subtiles() const;

  const SortingConfig config_;
  const Place place_;
  const FrameJob& job_;
  const SaturationBoard& board_;
  MemoryPort& port_;
  FifoSelector<SplatToken> inputs_;
  TimedFifo<SplatToken>& output_;
  Activity activity_;
  std::vector<Splat> buffer_;
  std::vector<SpillRun> runs_;
  std::uint64_t spill_used_ = 0;
  std::uint32_t group_ = 0, visit_ = 0;
  std::uint64_t received_ = 0, emitted_ = 0;  // splats of this visit
  SortingCounters counters_;
};

}  // namespace sgs
