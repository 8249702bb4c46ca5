// Hierarchical filtering unit (HFU): a coarse and a fine filter that share a path to memory. In
// paper order the one feeds the other; in exact order the keys are merged in between.
#pragma once

#include <cstdint>
#include <memory>
#include <systemc>
#include <vector>

#include "modules/hfu/coarse_filter.h"
#include "modules/hfu/fine_filter.h"

namespace sgs {

struct HfuCounters {
  std::uint64_t visits = 0;        // shares of visits, empty ones included
  std::uint64_t first_halves = 0;  // fetched
  std::uint64_t coarse_tests = 0;  // made
  std::uint64_t coarse_passed = 0;
  std::uint64_t second_halves = 0;  // fetched
  std::uint64_t fine_tests = 0;
  std::uint64_t splats = 0;             // passed on
  std::uint64_t dropped_saturated = 0;  // Gaussians and candidates dropped: the group was finished
};

class Hfu : public sc_core::sc_module {
 public:
  // codebooks: null where second halves are not quantised.
  // Paper order. splats: one FIFO a sorting unit; visit v goes to v modulo their number.
  Hfu(const sc_core::sc_module_name& name, const HfuConfig& config, const ClockDomain& clock,
      const FrameJob& job, const SaturationBoard& board, MemoryPort& port,
      CodebookBuffer* codebooks, TimedFifo<VisitShare>& shares,
      std::vector<TimedFifo<SplatToken>*> splats);

  // Exact order. to_sorting: one FIFO a sorting unit; visit v goes to v modulo their number.
  // released: keys in final order, each of which gives one token in `splats`.
  Hfu(const sc_core::sc_module_name& name, const HfuConfig& config, const ClockDomain& clock,
      const FrameJob& job, const SaturationBoard& board, MemoryPort& port,
      CodebookBuffer* codebooks, TimedFifo<VisitShare>& shares,
      std::vector<TimedFifo<FineCandidate>*> to_sorting, TimedFifo<FineCandidate>& released,
      TimedFifo<SplatToken>& splats);

  HfuCounters counters() const;
  std::vector<Activity*> activities();
  const Activity& coarse_activity() const { return coarse_.coarse_activity(); }
  const Activity& fine_activity() const { return fine_.fine_activity(); }
  // Null where second halves are not quantised.
  const Activity* decode_activity() const { return fine_.decode_activity(); }
  void trace(sc_core::sc_trace_file* file) const;

 private:
  std::unique_ptr<TimedFifo<FineCandidate>> candidates_;  // paper order only
  CoarseFilter coarse_;
  FineFilter fine_;
};

}  // namespace sgs
