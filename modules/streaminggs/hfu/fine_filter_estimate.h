// The time of a fine filter (fine_filter.h) without a kernel.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <queue>
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
    bool mark = false;         // there is no Gaussian
    std::uint32_t parts = 1;   // of the group that it may touch, a bit each
    std::uint32_t splats = 0;  // of these, that it does touch
    // [part] from which cycle on it is known to be finished, as far as that is known
    const std::uint64_t* finished_from = nullptr;
  };
  // Which came to `candidates` before. splats(part): the FIFO behind a part's pipeline.
  // hand_on(part, cycle, tested): puts what becomes of it in a part into that, which has a place
  // for it then; tested: a fine test is done. Not where nothing is said of what is no splat.
  template <class Splats, class HandOn>
  void take(const Candidate& candidate, FifoTimes& candidates, const Splats& splats,
            const HandOn& hand_on) {
    const Fetched fetched = fetch(candidate, candidates);
    freed_ = 0;
    for (std::uint32_t p = 0; p < parts_.size(); ++p) {
      if ((fetched.goes_to >> p & 1U) == 0) continue;
      Part& part = parts_[p];
      fetch_ = part.fetched.push(fetch_);
      FifoTimes& behind = splats(p);
      const Filtered filtered = filter(p, candidate, fetched, behind);
      if (candidate.mark || filtered.splat || reports_) {
        hand_on(p, filtered.leaves, filtered.tested);
      } else if (filtered.tested) {
        behind.hold_place(filtered.leaves);
      }
    }
    if (fetched.parts != 0) slots_.push(freed_);
  }

  FineFilter::Work work() const;

 private:
  struct Fetched {
    std::uint32_t parts = 0, goes_to = 0;  // that want a second half; that see it or its mark
    std::uint64_t answered = 0;
  };
  struct Filtered {
    bool tested = false, splat = false;
    std::uint64_t leaves = 0;  // into the pipeline
  };
  struct Part {
    FifoTimes fetched, decoded;
    std::uint64_t decode = 0, filter = 0;  // until when they work, the FFU but for its lanes
    std::uint64_t lanes = 0;               // until when these do
    std::uint64_t decode_cycles = 0, filter_cycles = 0;
  };
  Fetched fetch(const Candidate& candidate, FifoTimes& candidates);
  Filtered filter(std::uint32_t part, const Candidate& candidate, const Fetched& fetched,
                  FifoTimes& splats);
  std::uint64_t pass_mark(Part& part, FifoTimes& from, FifoTimes& splats);
  void decode(Part& part, bool there, std::uint64_t finished_from, std::uint64_t answered);
  void free_slot(std::uint64_t cycle) { freed_ = std::max(freed_, cycle + read_cycles_); }

  const std::uint64_t interval_, test_cycles_, read_cycles_;
  const bool reports_;
  const RecordArray second_halves_;
  PortEstimate port_;
  CodebookEstimate* const codebooks_;
  std::priority_queue<std::uint64_t, std::vector<std::uint64_t>, std::greater<>>
      slots_;                // free from
  std::uint64_t freed_ = 0;  // that of the candidate at hand
  std::vector<Part> parts_;
  std::uint64_t fetch_ = 0;  // until when it works
  FineFilter::Work work_;
};

}  // namespace sgs
