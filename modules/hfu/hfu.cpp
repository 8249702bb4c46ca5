// The four threads of an HFU.
#include "modules/hfu/hfu.h"

#include <algorithm>

#include "algorithm/memory/records.h"
#include "algorithm/splat/coarse_bound.h"
#include "algorithm/splat/make_splat.h"

namespace sgs {

Hfu::Hfu(const sc_core::sc_module_name& name, const HfuConfig& config, const ClockDomain& clock,
         const FrameJob& job, const SaturationBoard& board, MemoryPort& port,
         TimedFifo<VisitShare>& shares, std::vector<TimedFifo<SplatToken>*> splats)
    : sc_module(name),
      config_(config),
      job_(job),
      board_(board),
      port_(port),
      shares_(shares),
      splats_(std::move(splats)),
      load_activity_(std::string(this->name()) + ".load", clock),
      coarse_activity_(std::string(this->name()) + ".coarse", clock),
      fetch_activity_(std::string(this->name()) + ".fetch", clock),
      fine_activity_(std::string(this->name()) + ".fine", clock),
      input_(std::size_t{2} * config.slice_gaussians * kFirstHalfBytes),
      second_halves_(std::size_t{config.second_half_slots} * kMaxSecondHalfBytes),
      slices_(std::string(this->name()) + ".slices", clock, 2),
      free_halves_(std::string(this->name()) + ".free_halves", clock, 2, 0),
      candidates_(std::string(this->name()) + ".candidates", clock, config.candidate_fifo_entries,
                  config.cfu_depth_cycles),
      fetched_(std::string(this->name()) + ".fetched", clock, config.second_half_slots + 1),
      free_slots_(std::string(this->name()) + ".free_slots", clock, config.second_half_slots, 0) {
  SC_THREAD(load);
  SC_THREAD(coarse);
  SC_THREAD(fetch);
  SC_THREAD(fine);
}

void Hfu::load() {
  free_halves_.push(0, load_activity_);
  free_halves_.push(1, load_activity_);
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
      slice.half = free_halves_.pop(load_activity_, ActivityState::kBlocked);
      if (slice.share.count > 0) {
        load_activity_.work(1);
        slice.ticket = start_read(
            port_, load_activity_, job_.layout.first_half_address(share.first),
            input_.data() + std::size_t{slice.half} * config_.slice_gaussians * kFirstHalfBytes,
            slice.share.count * kFirstHalfBytes, region_id(Region::kFirstHalves));
        counters_.first_halves += slice.share.count;
      }
      share.first += slice.share.count;
      if (share.first < end) slice.share.mark = Mark::kNone;
      slices_.push(slice, load_activity_);
    } while (share.first < end);
  }
}

void Hfu::coarse() {
  while (true) {
    const Slice slice = slices_.pop(coarse_activity_);
    current_group_ = slice.share.group;
    current_visit_ = slice.share.visit;
    if (slice.share.count > 0) {
      await(port_, coarse_activity_, slice.ticket);
      filter_slice(slice);
    }
    free_halves_.push(slice.half, coarse_activity_);
    if (slice.share.mark != Mark::kNone) {
      ++counters_.visits;
      FineCandidate end;
      end.group = slice.share.group;
      end.visit = slice.share.visit;
      end.mark = slice.share.mark;
      candidates_.push(end, coarse_activity_);
    }
  }
}

// The CFUs take `cfus` Gaussians at a time. Simulated time is only let pass where somebody could
// see it: before a candidate is handed on, and at the end.
void Hfu::filter_slice(const Slice& slice) {
  const PixelRect& pixels = job_.groups[slice.share.group];
  const std::byte* records =
      input_.data() + std::size_t{slice.half} * config_.slice_gaussians * kFirstHalfBytes;
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
    if (config_.coarse_filter) {
      ++counters_.coarse_tests;
      const CoarseBound bound = coarse_bound(job_.view, first.mean, first.scale_max);
      if (!bound.in_front || !touches(bound, pixels)) continue;
    }
    coarse_activity_.work(pending_cycles);
    pending_cycles = 0;
    FineCandidate candidate;
    candidate.group = slice.share.group;
    candidate.visit = slice.share.visit;
    candidate.slot = slice.share.first + i;
    candidate.mean_x = first.mean.x;
    candidate.mean_y = first.mean.y;
    candidate.mean_z = first.mean.z;
    candidate.scale_max = first.scale_max;
    candidates_.push(candidate, coarse_activity_);
  }
  coarse_activity_.work(pending_cycles);
}

void Hfu::fetch() {
  for (std::uint32_t slot = 0; slot < config_.second_half_slots; ++slot) {
    free_slots_.push(slot, fetch_activity_);
  }
  while (true) {
    FineCandidate candidate = candidates_.pop(fetch_activity_);
    if (candidate.mark == Mark::kNone) {
      if (board_.saturated(candidate.group)) {
        ++counters_.dropped_saturated;
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

void Hfu::fine() {
  while (true) {
    const FineCandidate candidate = fetched_.pop(fine_activity_);
    if (candidate.mark == Mark::kNone) {
      await(port_, fine_activity_, candidate.ticket);
      filter_candidate(candidate);
      continue;
    }
    SplatToken end;
    end.group = candidate.group;
    end.visit = candidate.visit;
    end.mark = candidate.mark;
    splats_[candidate.visit % splats_.size()]->push(end, fine_activity_);
  }
}

void Hfu::filter_candidate(const FineCandidate& candidate) {
  const FirstHalf first{{candidate.mean_x, candidate.mean_y, candidate.mean_z},
                        candidate.scale_max};
  const DecodedGaussian decoded = decode_raw_second_half(
      first, second_halves_.data() + std::size_t{candidate.buffer} * kMaxSecondHalfBytes,
      job_.layout.sh_degree);
  free_slots_.push(candidate.buffer, fine_activity_);
  if (board_.saturated(candidate.group)) {
    ++counters_.dropped_saturated;
    return;
  }
  fine_activity_.work(config_.ffu_interval_cycles());
  ++counters_.fine_tests;
  SplatToken token;
  if (!make_geometry(job_.view, decoded.gaussian, token.splat) ||
      !reaches_group(token.splat, job_.groups[candidate.group])) {
    return;
  }
  add_colour(job_.view, job_.layout.sh_degree, first.mean, decoded.sh, token.splat);
  token.splat.index = candidate.slot;
  token.group = candidate.group;
  token.visit = candidate.visit;
  splats_[candidate.visit % splats_.size()]->push(token, fine_activity_);
  ++counters_.splats;
}

void Hfu::trace(sc_core::sc_trace_file* file) const {
  for (const Activity* activity :
       {&load_activity_, &coarse_activity_, &fetch_activity_, &fine_activity_}) {
    activity->trace(file);
  }
  slices_.trace(file);
  candidates_.trace(file);
  fetched_.trace(file);
  sc_core::sc_trace(file, current_group_, std::string(name()) + ".group");
  sc_core::sc_trace(file, current_visit_, std::string(name()) + ".visit");
}

}  // namespace sgs
