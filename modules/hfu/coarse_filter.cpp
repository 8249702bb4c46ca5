// The two threads of the coarse filter.
#include "modules/hfu/coarse_filter.h"

#include <algorithm>

#include "algorithm/memory/records.h"
#include "algorithm/splat/coarse_bound.h"

namespace sgs {

CoarseFilter::CoarseFilter(const sc_core::sc_module_name& name, const std::string& unit,
                           const HfuConfig& config, const ClockDomain& clock, const FrameJob& job,
                           const SaturationBoard& board, MemoryPort& port,
                           TimedFifo<VisitShare>& shares,
                           std::vector<TimedFifo<FineCandidate>*> candidates)
    : sc_module(name),
      config_(config),
      job_(job),
      board_(board),
      port_(port),
      shares_(shares),
      candidates_(std::move(candidates)),
      unit_(unit),
      load_activity_(unit + ".load", clock),
      coarse_activity_(unit + ".coarse", clock),
      input_(std::size_t{config.input_slots} * config.slice_gaussians * kFirstHalfBytes),
      slices_(unit + ".slices", clock, config.input_slots),
      free_slots_(unit + ".free_input_slots", clock, config.input_slots, 0) {
  SC_THREAD(load);
  SC_THREAD(coarse);
}

void CoarseFilter::load() {
  for (std::uint32_t slot = 0; slot < config_.input_slots; ++slot) {
    free_slots_.push(slot, load_activity_);
  }
  while (true) {
    VisitShare share = shares_.pop(load_activity_);
    if (share.count > 0 && board_.saturated(share.group)) {
      counters_.dropped_saturated += share.count;
      share.count = 0;
    }
    const std::uint32_t end = share.first + share.count;
    do {
      Slice slice;
      slice.share = share;
      slice.share.count = std::min(end - share.first, config_.slice_gaussians);
      slice.slot = free_slots_.pop(load_activity_, ActivityState::kBlocked);
      if (slice.share.count > 0) {
        load_activity_.work(1);
        slice.ticket = start_read(
            port_, load_activity_, job_.layout.first_half_address(share.first),
            input_.data() + std::size_t{slice.slot} * config_.slice_gaussians * kFirstHalfBytes,
            slice.share.count * kFirstHalfBytes, region_id(Region::kFirstHalves));
        counters_.first_halves += slice.share.count;
      }
      share.first += slice.share.count;
      if (share.first < end) slice.share.mark = Mark::kNone;
      slices_.push(slice, load_activity_);
    } while (share.first < end);
  }
}

void CoarseFilter::coarse() {
  while (true) {
    const Slice slice = slices_.pop(coarse_activity_);
    current_group_ = slice.share.group;
    current_visit_ = slice.share.visit;
    if (slice.share.count > 0) {
      await(port_, coarse_activity_, slice.ticket);
      filter_slice(slice);
    }
    free_slots_.push(slice.slot, coarse_activity_);
    if (slice.share.mark != Mark::kNone) {
      ++counters_.visits;
      FineCandidate end;
      end.group = slice.share.group;
      end.visit = slice.share.visit;
      end.mark = slice.share.mark;
      end.release_below = slice.share.release_below;
      candidates_[end.visit % candidates_.size()]->push(end, coarse_activity_);
    }
  }
}

// The CFUs take `cfus` Gaussians at a time. Simulated time is only let pass where somebody could
// see it: before a candidate is handed on, and at the end.
void CoarseFilter::filter_slice(const Slice& slice) {
  const PixelRect& pixels = job_.groups[slice.share.group];
  const std::byte* records =
      input_.data() + std::size_t{slice.slot} * config_.slice_gaussians * kFirstHalfBytes;
  std::uint64_t pending_cycles = 0;
  for (std::uint32_t i = 0; i < slice.share.count; ++i) {
    if (i % config_.cfus == 0) {
      if (board_.saturated(slice.share.group)) {
        counters_.dropped_saturated += slice.share.count - i;
        break;
      }
      if (config_.coarse_filter) pending_cycles += config_.cfu_interval_cycles();
    }
    const FirstHalf first = decode_first_half(records + std::size_t{i} * kFirstHalfBytes);
    const CoarseBound bound = coarse_bound(job_.view, first.mean, first.scale_max);
    if (config_.coarse_filter) {
      ++counters_.tests;
      if (!bound.in_front || !touches(bound, pixels)) continue;
    }
    ++counters_.passed;
    coarse_activity_.work(pending_cycles);
    pending_cycles = 0;
    FineCandidate candidate;
    candidate.group = slice.share.group;
    candidate.visit = slice.share.visit;
    candidate.slot = slice.share.first + i;
    candidate.depth = bound.depth;
    candidate.mean_x = first.mean.x;
    candidate.mean_y = first.mean.y;
    candidate.mean_z = first.mean.z;
    candidate.scale_max = first.scale_max;
    candidates_[candidate.visit % candidates_.size()]->push(candidate, coarse_activity_);
  }
  coarse_activity_.work(pending_cycles);
}

void CoarseFilter::trace(sc_core::sc_trace_file* file) const {
  load_activity_.trace(file);
  coarse_activity_.trace(file);
  slices_.trace(file);
  sc_core::sc_trace(file, current_group_, unit_ + ".group");
  sc_core::sc_trace(file, current_visit_, unit_ + ".visit");
}

}  // namespace sgs
