// Second halves on their way.
#include "modules/streaminggs/hfu/fine_filter_estimate.h"

namespace sgs {

FineFilterEstimate::FineFilterEstimate(const HfuConfig& config, const FineFilter& unit,
                                       const RecordArray& second_halves, const PortEstimate& port,
                                       CodebookEstimate* codebooks)
    : interval_(unit.tests().interval_cycles()),
      test_cycles_(unit.test_cycles()),
      read_cycles_(FineFilter::read_cycles(second_halves.record_bytes)),
      second_halves_(second_halves),
      port_(port),
      codebooks_(codebooks),
      slots_(config.second_half_slots),
      fetched_(fetched_entries(config)),
      decoded_(kDecodedEntries, codebooks == nullptr ? 1 : codebooks->latency_cycles()) {}

FineFilterEstimate::Fetched FineFilterEstimate::fetch(const Candidate& candidate,
                                                      FifoTimes& candidates) {
  fetch_ = candidates.pop(fetch_);
  ++work_.fetch_cycles;
  Fetched fetched;
  fetched.there = !candidate.mark && candidate.finished_from > fetch_;
  if (fetched.there) {
    fetched.slot = fetches_++ % slots_.size();
    fetch_ = std::max(fetch_, slots_[fetched.slot]) + 1;
    port_.charge_to(candidate.group);
    const PortEstimate::Access access =
        port_.read(fetch_, second_halves_.address(candidate.slot), second_halves_.record_bytes,
                   second_halves_.region);
    fetch_ = access.sent;
    fetched.answered = access.answered;
    ++work_.counters.second_halves;
  } else {
    ++fetch_;
  }
  fetch_ = fetched_.push(fetch_);
  return fetched;
}

void FineFilterEstimate::decode(const Candidate& candidate, const Fetched& fetched) {
  decode_ = fetched_.front(decode_);
  std::uint64_t began = decode_;
  if (fetched.there) {
    began = decode_ = std::max(decode_, fetched.answered);
    ++work_.counters.taken;
    if (candidate.finished_from > decode_) {
      began = decode_ = std::max(decode_, codebooks_->loaded_at());
      decode_ += codebooks_->read_record();
    } else {
      ++decode_;
    }
    free_slot(fetched.slot, decode_);
  } else {
    ++decode_;
  }
  work_.decode_cycles += decode_ - began;
  fetched_.remove(decode_);
  decode_ = decoded_.push(decode_);
}

void FineFilterEstimate::count(const Candidate& candidate, bool fetched, bool tested) {
  if (candidate.mark) return;
  work_.counters.tests += tested ? 1 : 0;
  work_.counters.splats += tested && candidate.splat ? 1 : 0;
  work_.counters.dropped_saturated += tested ? 0 : 1;
  work_.counters.dropped_fetched += fetched && !tested ? 1 : 0;
}

}  // namespace sgs
