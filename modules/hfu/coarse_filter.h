// The coarse half of an HFU: streams shares of visits through the CFUs, which know only centre and
// largest scale.
// Timing: `cfus` Gaussians every cfu_interval_cycles; the next slices are fetched while this one is
// filtered. Function: algorithm/splat/coarse_bound.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <systemc>
#include <vector>

#include "modules/frame_job.h"
#include "modules/hfu/hfu_config.h"
#include "modules/messages.h"
#include "modules/saturation_board.h"
#include "tlm/memory_access.h"
#include "tlm/timed_fifo.h"

namespace sgs {

struct CoarseCounters {
  std::uint64_t visits = 0;        // shares of visits, empty ones included
  std::uint64_t first_halves = 0;  // fetched
  std::uint64_t tests = 0;
  std::uint64_t passed = 0;
  std::uint64_t dropped_saturated = 0;  // Gaussians: the group was finished
};

class CoarseFilter : public sc_core::sc_module {
 public:
  SC_HAS_PROCESS(CoarseFilter);
  // unit: prefix of the activities' names. candidates: visit v goes to v modulo their number.
  CoarseFilter(const sc_core::sc_module_name& name, const std::string& unit,
               const HfuConfig& config, const ClockDomain& clock, const FrameJob& job,
               const SaturationBoard& board, MemoryPort& port, TimedFifo<VisitShare>& shares,
               std::vector<TimedFifo<FineCandidate>*> candidates);

  const CoarseCounters& counters() const { return counters_; }
  Activity& load_activity() { return load_activity_; }
  Activity& coarse_activity() { return coarse_activity_; }
  const Activity& coarse_activity() const { return coarse_activity_; }
  void trace(sc_core::sc_trace_file* file) const;

 private:
  // One part of the input buffer, full of a visit's first halves.
  struct Slice {
    VisitShare share;  // mark: only with the last slice of a share
    std::uint64_t ticket = 0;
    std::uint32_t slot = 0;  // of the input buffer
  };

  void load();    // thread: first halves into the input buffer
  void coarse();  // thread: CFUs
  void filter_slice(const Slice& slice);

  const HfuConfig config_;
  const FrameJob& job_;
  const SaturationBoard& board_;
  MemoryPort& port_;
  TimedFifo<VisitShare>& shares_;
  std::vector<TimedFifo<FineCandidate>*> candidates_;
  const std::string unit_;
  Activity load_activity_, coarse_activity_;
  std::vector<std::byte> input_;  // [input_slots, slice_gaussians] first halves
  TimedFifo<Slice> slices_;       // filled slots
  TimedFifo<std::uint32_t> free_slots_;
  CoarseCounters counters_;
  std::uint32_t current_group_ = 0, current_visit_ = 0;  // for the waveform
};

}  // namespace sgs
