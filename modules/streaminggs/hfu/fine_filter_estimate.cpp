// Second halves on their way, and through each part's FFU.
#include "modules/streaminggs/hfu/fine_filter_estimate.h"

namespace sgs {

FineFilterEstimate::FineFilterEstimate(const HfuConfig& config, const FineFilter& unit,
                                       const RecordArray& second_halves, const PortEstimate& port,
                                       CodebookEstimate* codebooks)
    : interval_(unit.tests().interval_cycles()),
      test_cycles_(unit.test_cycles()),
      read_cycles_(codebooks == nullptr ? FineFilter::read_cycles(second_halves.record_bytes) : 0),
      reports_(unit.rejects() == Rejects::kReported),
      second_halves_(second_halves),
      port_(port),
      codebooks_(codebooks),
      parts_(unit.parts(),
             {FifoTimes(fetched_entries(config)),
              FifoTimes(kDecodedEntries, codebooks == nullptr ? 1 : codebooks->latency_cycles())}) {
  for (std::uint32_t slot = 0; slot < config.second_half_slots; ++slot) slots_.push(0);
}

FineFilterEstimate::Fetched FineFilterEstimate::fetch(const Candidate& candidate,
                                                      FifoTimes& candidates) {
  const std::uint32_t all = (1U << parts_.size()) - 1;
  fetch_ = candidates.pop(fetch_);
  ++work_.fetch_cycles;
  Fetched fetched;
  std::uint32_t dropped = 0;
  if (!candidate.mark) {
    for (std::uint32_t p = 0; p < parts_.size(); ++p) {
      if ((candidate.parts >> p & 1U) == 0) continue;
      if (candidate.finished_from[p] > fetch_) {
        fetched.parts |= 1U << p;
      } else {
        ++dropped;
      }
    }
  }
  work_.counters.dropped_saturated += dropped;
  if (fetched.parts == 0) {
    ++fetch_;
    if (candidate.mark || reports_) fetched.goes_to = all;
    return fetched;
  }
  work_.counters.dropped_fetched += dropped;
  fetched.goes_to = fetched.parts;
  fetch_ = std::max(fetch_, slots_.top()) + 1;
  slots_.pop();
  port_.charge_to(candidate.group);
  const PortEstimate::Access access =
      port_.read(fetch_, second_halves_.address(candidate.slot), second_halves_.record_bytes,
                 second_halves_.region);
  fetch_ = access.sent;
  fetched.answered = access.answered;
  ++work_.counters.second_halves;
  return fetched;
}

void FineFilterEstimate::decode(Part& part, bool there, std::uint64_t finished_from,
                                std::uint64_t answered) {
  part.decode = part.decoded.room(part.fetched.front(part.decode));
  std::uint64_t began = part.decode;
  if (there) {
    began = part.decode = std::max(part.decode, answered);
    ++work_.counters.taken;
    if (finished_from > part.decode) {
      began = part.decode = std::max(part.decode, codebooks_->loaded_at());
      part.decode += codebooks_->read_record();
    } else {
      ++part.decode;
    }
    free_slot(part.decode);
  } else {
    ++part.decode;
  }
  part.decode_cycles += part.decode - began;
  part.fetched.remove(part.decode);
  part.decode = part.decoded.push(part.decode);
}

// Beside what the lanes do.
std::uint64_t FineFilterEstimate::pass_mark(Part& part, FifoTimes& from, FifoTimes& splats) {
  part.filter = splats.room(from.front(part.filter));
  part.filter_cycles += part.filter < part.lanes ? 0 : 1;
  from.remove(part.filter++);
  return part.filter;
}

FineFilterEstimate::Filtered FineFilterEstimate::filter(std::uint32_t p, const Candidate& candidate,
                                                        const Fetched& fetched, FifoTimes& splats) {
  Part& part = parts_[p];
  const bool there = (fetched.parts >> p & 1U) != 0;
  const std::uint64_t finished_from = there ? candidate.finished_from[p] : 0;
  if (codebooks_ != nullptr) decode(part, there, finished_from, fetched.answered);
  FifoTimes& from = codebooks_ != nullptr ? part.decoded : part.fetched;
  if (!there) return {false, false, pass_mark(part, from, splats)};
  part.filter = from.front(std::max(part.filter, part.lanes));
  if (codebooks_ == nullptr) {
    part.filter = std::max(part.filter, fetched.answered);
    ++work_.counters.taken;
  }
  part.filter = splats.room(part.filter);
  const std::uint64_t began = part.filter;
  const bool tested = finished_from > part.filter;
  const bool splat = tested && (candidate.splats >> p & 1U) != 0;
  if (tested) part.filter = next_turn(part.filter, interval_);
  if (codebooks_ == nullptr) free_slot(part.filter);
  from.remove(part.filter);
  part.lanes = part.filter + (tested ? test_cycles_ : 1);
  part.filter_cycles += part.lanes - began;
  const std::uint64_t leaves = ++part.filter;
  work_.counters.tests += tested ? 1 : 0;
  work_.counters.splats += splat ? 1 : 0;
  work_.counters.dropped_saturated += tested ? 0 : 1;
  work_.counters.dropped_fetched += tested ? 0 : 1;
  return {tested, splat, leaves};
}

FineFilter::Work FineFilterEstimate::work() const {
  FineFilter::Work work = work_;
  for (const Part& part : parts_) {
    work.parts.push_back({part.decode_cycles, part.filter_cycles, part.fetched.pushed(),
                          codebooks_ == nullptr ? 0 : part.decoded.pushed()});
  }
  work.traffic = port_.traffic();
  return work;
}

}  // namespace sgs
