// The threads of the fine filter.
#include "modules/hfu/fine_filter.h"

#include "algorithm/memory/second_half.h"
#include "algorithm/splat/make_splat.h"

namespace sgs {

FineFilter::FineFilter(const sc_core::sc_module_name& name, const std::string& unit,
                       const HfuConfig& config, const ClockDomain& clock, const FrameJob& job,
                       const SaturationBoard& board, MemoryPort& port, CodebookBuffer* codebooks,
                       TimedFifo<FineCandidate>& candidates,
                       std::vector<TimedFifo<SplatToken>*> splats, Rejects rejects)
    : sc_module(name),
      config_(config),
      job_(job),
      board_(board),
      port_(port),
      codebooks_(codebooks),
      candidates_(candidates),
      splats_(std::move(splats)),
      rejects_(rejects),
      fetch_activity_(unit + ".fetch", clock),
      decode_activity_(unit + ".decode", clock),
      fine_activity_(unit + ".fine", clock),
      record_bytes_(job.layout.second_half_bytes()),
      second_halves_(std::size_t{config.second_half_slots} * record_bytes_),
      fetched_(unit + ".fetched", clock, config.second_half_slots + 1),
      free_slots_(unit + ".free_slots", clock, config.second_half_slots, 0) {
  SC_THREAD(fetch);
  SC_THREAD(fine);
  if (codebooks_ == nullptr) return;
  decoded_ = std::make_unique<TimedFifo<Decoded>>(unit + ".decoded", clock, kDecodedEntries,
                                                  codebooks_->latency_cycles());
  SC_THREAD(decode);
}

std::vector<Activity*> FineFilter::activities() {
  if (codebooks_ == nullptr) return {&fetch_activity_, &fine_activity_};
  return {&fetch_activity_, &decode_activity_, &fine_activity_};
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
                     second_halves_.data() + std::size_t{candidate.buffer} * record_bytes_,
                     record_bytes_, region_id(Region::kSecondHalves));
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

// The next candidate in order, its second half read from what was fetched.
FineFilter::Decoded FineFilter::take_fetched(Activity& activity) {
  Decoded out;
  out.candidate = fetched_.pop(activity);
  const FineCandidate& candidate = out.candidate;
  if (candidate.mark != Mark::kNone) return out;
  await(port_, activity, candidate.ticket);
  const SecondHalfFormat& format = job_.layout.second_half;
  const std::byte* record = second_halves_.data() + std::size_t{candidate.buffer} * record_bytes_;
  if (codebooks_ != nullptr && !board_.saturated(candidate.group)) {
    codebooks_->read_entries(decode_indices(format, record), activity);
  }
  const FirstHalf first{{candidate.mean_x, candidate.mean_y, candidate.mean_z},
                        candidate.scale_max};
  out.second = decode_second_half(format, first, record,
                                  codebooks_ != nullptr ? codebooks_->bytes() : nullptr);
  free_slots_.push(candidate.buffer, activity);
  return out;
}

void FineFilter::decode() {
  while (true) decoded_->push(take_fetched(decode_activity_), decode_activity_);
}

void FineFilter::fine() {
  while (true) {
    const Decoded next = decoded_ ? decoded_->pop(fine_activity_) : take_fetched(fine_activity_);
    if (next.candidate.mark == Mark::kNone) {
      filter(next);
      continue;
    }
    SplatToken end;
    end.group = next.candidate.group;
    end.visit = next.candidate.visit;
    end.mark = next.candidate.mark;
    splats_[end.visit % splats_.size()]->push(end, fine_activity_);
  }
}

void FineFilter::filter(const Decoded& decoded) {
  const FineCandidate& candidate = decoded.candidate;
  if (board_.saturated(candidate.group)) {
    ++counters_.dropped_saturated;
    reject(candidate);
    return;
  }
  fine_activity_.work(config_.ffu_interval_cycles());
  ++counters_.tests;
  SplatToken token;
  if (!make_geometry(job_.view, decoded.second.gaussian, token.splat) ||
      !reaches_group(token.splat, job_.groups[candidate.group])) {
    reject(candidate);
    return;
  }
  add_colour(job_.view, job_.layout.sh_degree(), decoded.second.gaussian.mean, decoded.second.sh,
             token.splat);
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
  if (codebooks_ != nullptr) decode_activity_.trace(file);
  fine_activity_.trace(file);
  fetched_.trace(file);
  if (decoded_) decoded_->trace(file);
}

}  // namespace sgs
