// Slices of a share.
#include "modules/streaminggs/hfu/coarse_filter_estimate.h"

#include <utility>

namespace sgs {

CoarseFilterEstimate::CoarseFilterEstimate(const HfuConfig& config, const CoarseFilter& unit,
                                           const RecordArray& first_halves,
                                           const PortEstimate& port)
    : config_(config),
      turns_(unit.tests(), unit.with_cfus()),
      copies_(unit.tests().copies),
      parts_(unit.parts()),
      first_halves_(first_halves),
      port_(port),
      slots_(config.input_slots),
      slices_(config.input_slots) {}

void CoarseFilterEstimate::begin(const Share& share, FifoTimes& shares, FifoTimes& survivors) {
  load_ = shares.pop(load_);
  share_ = share;
  survivors_ = &survivors;
  if (share.count > 0 && share.finished_from <= load_) {
    work_.counters.dropped_saturated += share.count;
    share_.count = 0;
  }
  at_ = slice_begin_ = slice_end_ = share_.first;
  end_ = share_.first + share_.count;
}

// As CoarseFilter::filter_slice() and what is around it; an empty share has an empty slice.
bool CoarseFilterEstimate::next_slice() {
  if (slot_ != nullptr) {
    if (slice_end_ > slice_begin_) {
      if (filter_ == slice_from_ && slice_end_ < end_) ++filter_;
      work_.filter_cycles += filter_ - passed_;
    }
    *std::exchange(slot_, nullptr) = filter_;
    if (slice_end_ == end_) return false;
  }
  slice_begin_ = at_ = slice_end_;
  slice_end_ = slice_begin_ + std::min(end_ - slice_begin_, config_.slice_gaussians);
  slot_ = &slots_[work_.slices % slots_.size()];
  ++work_.slices;
  load_ = std::max(load_, *slot_) + 1;
  ++work_.load_cycles;
  const std::uint32_t count = slice_end_ - slice_begin_;
  const std::uint64_t there = count > 0 ? fetch(share_.group, slice_begin_, count) : 0;
  slices_.push(load_);
  filter_ = std::max(slices_.pop(filter_), there);
  slice_from_ = passed_ = filter_;
  return true;
}

void CoarseFilterEstimate::end() {
  ++work_.counters.shares;
  ++work_.filter_cycles;
  filter_ = survivors_->room(filter_) + 1;
}

std::uint64_t CoarseFilterEstimate::fetch(std::uint32_t group, std::uint32_t first,
                                          std::uint32_t count) {
  port_.charge_to(group);
  const auto [sent, answered] =
      port_.read(load_, first_halves_.address(first), count * first_halves_.record_bytes,
                 first_halves_.region);
  load_ = sent;
  work_.counters.first_halves += count;
  return answered;
}

}  // namespace sgs
