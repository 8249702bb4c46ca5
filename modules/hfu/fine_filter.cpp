// The two threads of the fine filter.
#include "modules/hfu/fine_filter.h"

#include "algorithm/memory/records.h"
#include "algorithm/splat/make_splat.h"

namespace sgs {

FineFilter::FineFilter(const sc_core::sc_module_name& name, const std::string& unit,
                       const HfuConfig& config, const ClockDomain& clock, const FrameJob& job,
                       const SaturationBoard& board, MemoryPort& port,
                       TimedFifo<FineCandidate>& candidates,
                       std::vector<TimedFifo<SplatToken>*> splats, Rejects rejects)
    : sc_module(name),
      config_(config),
      job_(job),
      board_(board),
      port_(port),
      candidates_(candidates),
      splats_(std::move(splats)),
      rejects_(rejects),
      fetch_activity_(unit + ".fetch", clock),
      fine_activity_(unit + ".fine", clock),
      second_halves_(std::size_t{config.second_half_slots} * kMaxSecondHalfBytes),
      fetched_(unit + ".fetched", clock, config.second_half_slots + 1),
      free_slots_(unit + ".free_slots", clock, config.second_half_slots, 0) {
  SC_THREAD(fetch);
  SC_THREAD(fine);
}

void FineFilter::fetch() {
  for (std::uint32_t slot = 0; slot < config_.second_half_slots; ++slot) {
    free_slots_.push(slot, fetch_activity_);
  }
  while (true) {
    FineCandidate candidate = candidates_.pop(fetch_activity_);
    if (candidate.mark == Mark::kNone) {
      if (board_.saturated(candidate.group)) {
        drop_saturated(candidate);
        continue;
      }
      candidate.buffer = free_slots_.pop(fetch_activity_, ActivityState::kBlocked);
      fetch_activity_.work(1);
      candidate.ticket =
          start_read(port_, fetch_activity_, job_.layout.second_half_address(candidate.slot),
                     second_halves_.data() + std::size_t{candidate.buffer} * kMaxSecondHalfBytes,
                     job_.layout.second_half_bytes(), region_id(Region::kSecondHalves));
      ++counters_.second_halves;
    }
    fetched_.push(candidate, fetch_activity_);
  }
}

// A token that nothing follows keeps its place in the order all the same.
void FineFilter::drop_saturated(const FineCandidate& candidate) {
  ++counters_.dropped_saturated;
  if (rejects_ == Rejects::kDropped) return;
  FineCandidate rejected = candidate;
  rejected.mark = Mark::kRejected;
  fetched_.push(rejected, fetch_activity_);
}

void FineFilter::fine() {
  while (true) {
    const FineCandidate candidate = fetched_.pop(fine_activity_);
    if (candidate.mark == Mark::kNone) {
      await(port_, fine_activity_, candidate.ticket);
      filter(candidate);
      continue;
    }
    SplatToken end;
    end.group = candidate.group;
    end.visit = candidate.visit;
    end.mark = candidate.mark;
    splats_[candidate.visit % splats_.size()]->push(end, fine_activity_);
  }
}

void FineFilter::filter(const FineCandidate& candidate) {
  const FirstHalf first{{candidate.mean_x, candidate.mean_y, candidate.mean_z},
                        candidate.scale_max};
  const DecodedGaussian decoded = decode_raw_second_half(
      first, second_halves_.data() + std::size_t{candidate.buffer} * kMaxSecondHalfBytes,
      job_.layout.sh_degree);
  free_slots_.push(candidate.buffer, fine_activity_);
  if (board_.saturated(candidate.group)) {
    ++counters_.dropped_saturated;
    reject(candidate);
    return;
  }
  fine_activity_.work(config_.ffu_interval_cycles());
  ++counters_.tests;
  SplatToken token;
  if (!make_geometry(job_.view, decoded.gaussian, token.splat) ||
      !reaches_group(token.splat, job_.groups[candidate.group])) {
    reject(candidate);
    return;
  }
  add_colour(job_.view, job_.layout.sh_degree, first.mean, decoded.sh, token.splat);
  token.splat.index = candidate.slot;
  token.group = candidate.group;
  token.visit = candidate.visit;
  splats_[candidate.visit % splats_.size()]->push(token, fine_activity_);
  ++counters_.splats;
}

void FineFilter::reject(const FineCandidate& candidate) {
  if (rejects_ == Rejects::kDropped) return;
  SplatToken token;
  token.group = candidate.group;
  token.visit = candidate.visit;
  token.mark = Mark::kRejected;
  splats_[candidate.visit % splats_.size()]->push(token, fine_activity_);
}

void FineFilter::trace(sc_core::sc_trace_file* file) const {
  fetch_activity_.trace(file);
  fine_activity_.trace(file);
  fetched_.trace(file);
}

}  // namespace sgs
