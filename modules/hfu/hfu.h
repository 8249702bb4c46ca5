// Hierarchical filtering unit (HFU): streams its share of each visit through the coarse filters
// (CFU), fetches the second half of what passes, and puts that through the fine filter (FFU).
// Timing: `cfus` Gaussians every cfu_interval_cycles, one candidate every ffu_interval_cycles; the
// next slice is fetched while this one is filtered. Function: algorithm/splat/coarse_bound.h,
// make_splat.h.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <systemc>
#include <vector>

#include "modules/frame_job.h"
#include "modules/hfu/hfu_config.h"
#include "modules/messages.h"
#include "modules/saturation_board.h"
#include "tlm/memory_access.h"
#include "tlm/timed_fifo.h"

namespace sgs {

struct HfuCounters {
  std::uint64_t visits = 0;         // shares of visits, empty ones included
  std::uint64_t first_halves = 0;   // fetched
  std::uint64_t coarse_tests = 0;   // made
  std::uint64_t second_halves = 0;  // fetched
  std::uint64_t fine_tests = 0;
  std::uint64_t splats = 0;             // handed to sorting
  std::uint64_t dropped_saturated = 0;  // Gaussians and candidates dropped: the group was finished
};

class Hfu : public sc_core::sc_module {
 public:
  SC_HAS_PROCESS(Hfu);
  // splats: one FIFO a sorting unit; visit v goes to v modulo their number.
  Hfu(const sc_core::sc_module_name& name, const HfuConfig& config, const ClockDomain& clock,
      const FrameJob& job, const SaturationBoard& board, MemoryPort& port,
      TimedFifo<VisitShare>& shares, std::vector<TimedFifo<SplatToken>*> splats);

  const HfuCounters& counters() const { return counters_; }
  std::array<Activity*, 4> activities() {
    return {&load_activity_, &coarse_activity_, &fetch_activity_, &fine_activity_};
  }
  const Activity& coarse_activity() const { return coarse_activity_; }
  const Activity& fine_activity() const { return fine_activity_; }
  void trace(sc_core::sc_trace_file* file) const;

 private:
  // One half of the input buffer, full of a visit's first halves.
  struct Slice {
    VisitShare share;  // mark: only with the last slice of a share
    std::uint64_t ticket = 0;
    std::uint32_t half = 0;
  };

  void load();    // thread: first halves into the input buffer
  void coarse();  // thread: CFUs
  void fetch();   // thread: second halves of the candidates
  void fine();    // thread: FFU
  void filter_slice(const Slice& slice);
  void filter_candidate(const FineCandidate& candidate);

  const HfuConfig config_;
  const FrameJob& job_;
  const SaturationBoard& board_;
  MemoryPort& port_;
  TimedFifo<VisitShare>& shares_;
  std::vector<TimedFifo<SplatToken>*> splats_;
  Activity load_activity_, coarse_activity_, fetch_activity_, fine_activity_;
  std::vector<std::byte> input_;          // two halves of slice_gaussians first halves
  std::vector<std::byte> second_halves_;  // second_half_slots records
  TimedFifo<Slice> slices_;               // filled halves
  TimedFifo<std::uint32_t> free_halves_;
  TimedFifo<FineCandidate> candidates_;
  TimedFifo<FineCandidate> fetched_;
  TimedFifo<std::uint32_t> free_slots_;
  HfuCounters counters_;
  std::uint32_t current_group_ = 0, current_visit_ = 0;  // for the waveform
};

}  // namespace sgs
