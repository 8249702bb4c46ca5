// The time of a fine filter (fine_filter.h) without a kernel, for groups in one part.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "algorithm/memory/regions.h"
#include "modules/datapath/work_rates.h"
#include "modules/streaminggs/hfu/codebook_estimate.h"
#include "modules/streaminggs/hfu/fine_filter.h"
#include "tlm/fifo_times.h"
#include "tlm/port_estimate.h"

namespace sgs {

class FineFilterEstimate {
 public:
  // codebooks: null where second halves are not quantised.
  FineFilterEstimate(const HfuConfig& config, const FineFilter& unit,
                     const RecordArray& second_halves, const PortEstimate& port,
                     CodebookEstimate* codebooks);

  struct Candidate {
    std::uint32_t group = 0, slot = 0;
    bool mark = false;                // there is no Gaussian
    bool splat = false;               // it touches the group
    std::uint64_t finished_from = 0;  // its group, as far as that is known
  };
  // Which came to `candidates` before. hand_on(cycle, tested): gives what becomes of it to
  // `splats`, which has a place for it then; tested: a fine test is done.
  template <class HandOn>
  void take(const Candidate& candidate, FifoTimes& candidates, const FifoTimes& splats,
            const HandOn& hand_on) {
    const Fetched fetched = fetch(candidate, candidates);
    if (codebooks_ != nullptr) decode(candidate, fetched);
    FifoTimes& from = codebooks_ != nullptr ? decoded_ : fetched_;
    const std::uint64_t there = from.front(0);
    const bool waited = there < filter_;
    filter_ = std::max(filter_, there);
    bool tested = false;
    if (fetched.there) {
      if (codebooks_ == nullptr) {
        filter_ = std::max(filter_, fetched.answered);
        ++work_.counters.taken;
      }
      filter_ = splats.room(filter_);
      const std::uint64_t began = filter_;
      tested = candidate.finished_from > filter_;
      if (tested) filter_ = next_turn(filter_, interval_);
      if (codebooks_ == nullptr) free_slot(fetched.slot, filter_);
      from.remove(filter_);
      const std::uint64_t of_test = tested ? test_cycles_ : 1;
      work_.filter_cycles += filter_ + of_test - began;
      hand_on(filter_ + 1, tested);
      filter_ += of_test;
    } else {
      filter_ = splats.room(filter_);
      from.remove(filter_);
      filter_ += waited ? 0 : 1;
      work_.filter_cycles += waited ? 0 : 1;
      hand_on(filter_, tested);
    }
    count(candidate, fetched.there, tested);
  }

  FineFilter::Work work() const {
    FineFilter::Work work = work_;
    work.fetched = fetched_.pushed();
    work.decoded = codebooks_ == nullptr ? 0 : decoded_.pushed();
    work.traffic = port_.traffic();
    return work;
  }

 private:
  struct Fetched {
    bool there = false;  // a second half
    std::uint64_t slot = 0, answered = 0;
  };
  Fetched fetch(const Candidate& candidate, FifoTimes& candidates);
  void decode(const Candidate& candidate, const Fetched& fetched);
  void free_slot(std::uint64_t slot, std::uint64_t cycle) { slots_[slot] = cycle + read_cycles_; }
  void count(const Candidate& candidate, bool fetched, bool tested);

  const std::uint64_t interval_, test_cycles_, read_cycles_;
  const RecordArray second_halves_;
  PortEstimate port_;
  CodebookEstimate* const codebooks_;
  std::vector<std::uint64_t> slots_;  // ring: when they were free again
  FifoTimes fetched_, decoded_;
  std::uint64_t fetches_ = 0;
  std::uint64_t fetch_ = 0, decode_ = 0, filter_ = 0;  // until when they work
  FineFilter::Work work_;
};

}  // namespace sgs
