// Wiring of an HFU's two filters.
#include "modules/hfu/hfu.h"

namespace sgs {

Hfu::Hfu(const sc_core::sc_module_name& name, const HfuConfig& config, const ClockDomain& clock,
         const FrameJob& job, const SaturationBoard& board, MemoryPort& port,
         CodebookBuffer* codebooks, TimedFifo<VisitShare>& shares,
         std::vector<TimedFifo<SplatToken>*> splats)
    : sc_module(name),
      candidates_(std::make_unique<TimedFifo<FineCandidate>>(
          std::string(this->name()) + ".candidates", clock, config.candidate_fifo_entries,
          config.cfu_depth_cycles)),
      coarse_("coarse_filter", this->name(), config, clock, job, board, port, shares,
              {candidates_.get()}),
      fine_("fine_filter", this->name(), config, clock, job, board, port, codebooks, *candidates_,
            std::move(splats), Rejects::kDropped) {}

Hfu::Hfu(const sc_core::sc_module_name& name, const HfuConfig& config, const ClockDomain& clock,
         const FrameJob& job, const SaturationBoard& board, MemoryPort& port,
         CodebookBuffer* codebooks, TimedFifo<VisitShare>& shares,
         std::vector<TimedFifo<FineCandidate>*> to_sorting, TimedFifo<FineCandidate>& released,
         TimedFifo<SplatToken>& splats)
    : sc_module(name),
      coarse_("coarse_filter", this->name(), config, clock, job, board, port, shares,
              std::move(to_sorting)),
      fine_("fine_filter", this->name(), config, clock, job, board, port, codebooks, released,
            {&splats}, Rejects::kReported) {}

std::vector<Activity*> Hfu::activities() {
  std::vector<Activity*> all = {&coarse_.load_activity(), &coarse_.coarse_activity()};
  for (Activity* activity : fine_.activities()) all.push_back(activity);
  return all;
}

HfuCounters Hfu::counters() const {
  const CoarseCounters& c = coarse_.counters();
  const FineCounters& f = fine_.counters();
  return {c.visits,        c.first_halves, c.tests,  c.passed,
          f.second_halves, f.tests,        f.splats, c.dropped_saturated + f.dropped_saturated};
}

void Hfu::trace(sc_core::sc_trace_file* file) const {
  coarse_.trace(file);
  if (candidates_) candidates_->trace(file);
  fine_.trace(file);
}

}  // namespace sgs
