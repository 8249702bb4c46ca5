// The time of a coarse filter (coarse_filter.h) without a kernel, for groups in one part.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <limits>
#include <vector>

#include "algorithm/memory/regions.h"
#include "modules/streaminggs/hfu/cfu_turns.h"
#include "modules/streaminggs/hfu/coarse_filter.h"
#include "tlm/fifo_times.h"
#include "tlm/port_estimate.h"

namespace sgs {

class CoarseFilterEstimate {
 public:
  CoarseFilterEstimate(const HfuConfig& config, const CoarseFilter& unit,
                       const RecordArray& first_halves, const PortEstimate& port);

  // A share of a visit as it goes through, which came to `shares` before.
  struct Share {
    std::uint32_t group = 0, first = 0, count = 0;  // storage slots
    std::uint64_t finished_from = 0;                // its group, as far as that is known
  };
  // passes(slot): whether the Gaussian does; hand_on(cycle): gives the next candidate to `keys`,
  // end_visit(cycle): the mark behind them.
  template <class Passes, class HandOn, class End>
  void take(const Share& share, FifoTimes& shares, const FifoTimes& keys, const Passes& passes,
            const HandOn& hand_on, const End& end_visit) {
    load_ = shares.pop(load_);
    std::uint32_t count = share.count;
    if (count > 0 && share.finished_from <= load_) {
      work_.counters.dropped_saturated += count;
      count = 0;
    }
    std::uint32_t at = share.first;
    const std::uint32_t end = share.first + count;
    do {
      const std::uint32_t of_slice = std::min(end - at, config_.slice_gaussians);
      std::uint64_t& slot = slots_[work_.slices % slots_.size()];
      ++work_.slices;
      load_ = std::max(load_, slot) + 1;
      ++work_.load_cycles;
      const std::uint64_t there = of_slice > 0 ? fetch(share.group, at, of_slice) : 0;
      slices_.push(load_);
      filter_ = std::max(slices_.pop(filter_), there);
      if (of_slice > 0) filter(share, at, of_slice, at + of_slice < end, keys, passes, hand_on);
      slot = filter_;
      at += of_slice;
    } while (at < end);
    ++work_.counters.shares;
    ++work_.filter_cycles;
    filter_ = place_in(keys, filter_) + 1;
    end_visit(filter_);
  }

  CoarseFilter::Work work() const {
    CoarseFilter::Work work = work_;
    work.counters.tests_of_parts = work.counters.tests;
    work.counters.passed = work.counters.candidates;
    work.traffic = port_.traffic();
    return work;
  }

 private:
  // The cycle in which they are there.
  std::uint64_t fetch(std::uint32_t group, std::uint32_t first, std::uint32_t count);

  // As CoarseFilter::filter_slice().
  template <class Passes, class HandOn>
  void filter(const Share& share, std::uint32_t first, std::uint32_t count, bool more,
              const FifoTimes& keys, const Passes& passes, const HandOn& hand_on) {
    const std::uint64_t began = filter_;
    std::uint64_t passed = began, cycle = began;
    for (std::uint32_t i = 0; i < count; ++i) {
      if (i % copies_ == 0 && share.finished_from <= passed) {
        work_.counters.dropped_saturated += count - i;
        break;
      }
      cycle = turns_.next(place_in(keys, cycle));
      ++work_.counters.read;
      work_.counters.tests += config_.coarse_filter ? 1 : 0;
      if (!passes(first + i)) {
        under_test_.push_back(cycle + depth_cycles_);
        continue;
      }
      ++work_.counters.candidates;
      work_.filter_cycles += cycle - passed;
      hand_on(cycle);
      passed = cycle;
    }
    if (cycle == began && more) ++cycle;
    work_.filter_cycles += cycle - passed;
    filter_ = cycle;
  }

  // The first cycle from `now` on in which `keys` has a place for one more beside what is under
  // test and will not pass.
  std::uint64_t place_in(const FifoTimes& keys, std::uint64_t now) {
    for (;;) {
      while (!under_test_.empty() && under_test_.front() <= now) under_test_.pop_front();
      const std::uint64_t room =
          under_test_.size() < keys.capacity() ? keys.room(now, under_test_.size()) : kNever;
      if (room == now) return now;
      now = under_test_.empty() ? room : std::min(room, under_test_.front());
    }
  }

  static constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();
  const HfuConfig config_;
  const std::uint64_t depth_cycles_;
  const CfuTurns turns_;
  const std::uint32_t copies_;
  const RecordArray first_halves_;
  PortEstimate port_;
  std::vector<std::uint64_t> slots_;      // ring: when the slices in them were filtered
  std::deque<std::uint64_t> under_test_;  // and will not pass: when they leave the pipeline
  FifoTimes slices_;
  std::uint64_t load_ = 0, filter_ = 0;  // until when they work
  CoarseFilter::Work work_;
};

}  // namespace sgs
