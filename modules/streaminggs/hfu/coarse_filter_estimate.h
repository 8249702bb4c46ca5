// The time of a coarse filter (coarse_filter.h) without a kernel.
#pragma once

#include <algorithm>
#include <cstdint>
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
    std::uint64_t finished_from = 0;  // all parts of its group, as far as that is known
  };
  // Its candidates go to `survivors`.
  void begin(const Share& share, FifoTimes& shares, FifoTimes& survivors);
  // Goes on to the next Gaussian that passes, at(): passes(slot) says in how many parts of the
  // group it does, in cycle now(), which has a place for it. False: there is none left.
  template <class Passes>
  bool next(const Passes& passes) {
    while (true) {
      while (at_ < slice_end_) {
        if ((at_ - slice_begin_) % copies_ == 0 && share_.finished_from <= passed_) {
          work_.counters.dropped_saturated += slice_end_ - at_;
          at_ = slice_end_;
          break;
        }
        wait_for_place();
        filter_ = turns_.next(filter_);
        ++work_.counters.read;
        work_.counters.tests += config_.coarse_filter ? 1 : 0;
        const std::uint32_t parts = passes(at_++);
        if (parts == 0) {
          survivors_->hold_place(filter_);
          continue;
        }
        work_.counters.passed += parts;
        ++work_.counters.candidates;
        work_.filter_cycles += filter_ - passed_;
        return true;
      }
      if (!next_slice()) return false;
    }
  }
  std::uint32_t at() const { return at_ - 1; }
  std::uint64_t now() const { return filter_; }
  // What it has is taken in this cycle: the Gaussian, or the mark behind the share.
  void go_on(std::uint64_t cycle) { filter_ = passed_ = cycle; }
  // The mark behind them is ready, and has a place.
  void end();

  CoarseFilter::Work work() const {
    CoarseFilter::Work work = work_;
    work.counters.tests_of_parts = work.counters.tests * parts_;
    work.traffic = port_.traffic();
    return work;
  }

 private:
  // The cycle in which they are there.
  std::uint64_t fetch(std::uint32_t group, std::uint32_t first, std::uint32_t count);

  // Until there is a place for one more beside what is under test, and may pass or not.
  void wait_for_place() {
    const std::uint64_t room = survivors_->room(filter_);
    if (room == filter_) return;
    work_.filter_cycles += filter_ - passed_;
    filter_ = passed_ = room;
  }
  // The slice at hand is through, and the next one there: false where there is none.
  bool next_slice();

  const HfuConfig config_;
  const CfuTurns turns_;
  const std::uint32_t copies_, parts_;
  const RecordArray first_halves_;
  PortEstimate port_;
  std::vector<std::uint64_t> slots_;  // ring: when the slices in them were filtered
  FifoTimes slices_;
  std::uint64_t load_ = 0, filter_ = 0;                      // until when they work
  Share share_;                                              // at hand
  FifoTimes* survivors_ = nullptr;                           // that its candidates go to
  std::uint32_t at_ = 0;                                     // the Gaussian after the one at hand
  std::uint32_t slice_begin_ = 0, slice_end_ = 0, end_ = 0;  // of its slice, of its share
  std::uint64_t* slot_ = nullptr;                            // of the slice; null: none is at hand
  std::uint64_t slice_from_ = 0, passed_ = 0;  // when its filtering began; went on last
  CoarseFilter::Work work_;
};

}  // namespace sgs
