// The recurrences. Each vector holds a time for each of the things that pass one place in order;
// "at least k ago" is what a buffer of k places demands.
#include "testbench/units/hfu_timing_model.h"

#include <algorithm>

#include "modules/hfu/codebook_config.h"

namespace sgs::tb {
namespace {

using Cycle = std::uint64_t;

// A candidate, or the mark behind a share's last.
struct Item {
  Cycle offered;  // by the coarse filter, once its work is done
  bool mark;
};

// Time of the entry `places` before the next one, 0 while there is none.
Cycle before(const std::vector<Cycle>& times, std::size_t places) {
  return times.size() < places ? 0 : times[times.size() - places];
}

class Pipeline {
 public:
  Pipeline(const HfuConfig& config, Cycle latency, const std::optional<DecodeTiming>& decode)
      : config_(config), latency_(latency), decode_timing_(decode) {}

  void share(const std::vector<bool>& passes) {
    std::size_t at = 0;
    do {
      const std::size_t count = std::min<std::size_t>(passes.size() - at, config_.slice_gaussians);
      const Cycle data = load(count > 0);
      coarse_ = std::max(coarse_, loaded_ + 1);  // FIFO of slices
      slice_taken_.push_back(coarse_);
      if (count > 0) filter(passes, at, count, data);
      half_free_.push_back(coarse_);
      at += count;
    } while (at < passes.size());
    candidate(nullptr);
    ++share_;
    times_.shares_done.push_back(fine_);
  }

  const HfuTimes& times() const { return times_; }

 private:
  // Returns when the slice's bytes are there.
  Cycle load(bool any) {
    constexpr std::size_t kHalves = 2;
    // Input latency at the start; then a free half of the buffer.
    loaded_ = std::max({loaded_, Cycle{1}, before(half_free_, kHalves)});
    Cycle data = 0;
    if (any) {
      loaded_ += 1;
      data = loaded_ + latency_;
    }
    loaded_ = std::max(loaded_, before(slice_taken_, kHalves));
    return data;
  }

  void filter(const std::vector<bool>& passes, std::size_t at, std::size_t count, Cycle data) {
    coarse_ = std::max(coarse_, data);
    Cycle owed = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (i % config_.cfus == 0 && config_.coarse_filter) owed += config_.cfu_interval_cycles();
      if (!passes[at + i]) continue;
      spend(owed);
      const std::size_t gaussian = at + i;
      candidate(&gaussian);
    }
    spend(owed);
  }

  void spend(Cycle& owed) {
    coarse_ += owed;
    times_.coarse_busy += owed;
    owed = 0;
  }

  // From the coarse filter to sorting. gaussian: its place in the share; null: a mark.
  void candidate(const std::size_t* gaussian) {
    coarse_ = std::max(coarse_, before(candidate_taken_, config_.candidate_fifo_entries));
    fetch_ = std::max(fetch_, coarse_ + config_.cfu_depth_cycles);
    candidate_taken_.push_back(fetch_);
    Cycle data = 0;
    if (gaussian != nullptr) {
      fetch_ = std::max(fetch_, before(slot_free_, config_.second_half_slots)) + 1;
      data = fetch_ + latency_;
    }
    fetch_ = std::max(fetch_, before(fetched_taken_, config_.second_half_slots + 1));
    // The thread behind the fetches: the decode stage where there is one, else the FFU.
    Cycle& taker = decode_timing_ ? decode_ : fine_;
    taker = std::max(taker, fetch_ + 1);
    fetched_taken_.push_back(taker);
    if (gaussian != nullptr) {
      taker = std::max(taker, data);
      if (decode_timing_) read_lines(decode_timing_->lines[share_][*gaussian]);
      slot_free_.push_back(taker);
    }
    if (decode_timing_) hand_on();
    if (gaussian == nullptr) return;
    fine_ += config_.ffu_interval_cycles();
    times_.fine_busy += config_.ffu_interval_cycles();
  }

  void read_lines(Cycle lines) {
    decode_ += lines;
    times_.decode_busy += lines;
  }

  // From the decode stage to the FFU.
  void hand_on() {
    decode_ = std::max(decode_, before(decoded_taken_, kDecodedEntries));
    fine_ = std::max(fine_, decode_ + decode_timing_->latency_cycles);
    decoded_taken_.push_back(fine_);
  }

  const HfuConfig& config_;
  const Cycle latency_;
  const std::optional<DecodeTiming>& decode_timing_;
  std::size_t share_ = 0;
  // When each thread is free.
  Cycle loaded_ = 0, coarse_ = 0, fetch_ = 0, decode_ = 0, fine_ = 0;
  std::vector<Cycle> half_free_, slice_taken_, candidate_taken_, fetched_taken_, slot_free_,
      decoded_taken_;
  HfuTimes times_;
};

}  // namespace

HfuTimes hfu_times(const HfuConfig& config, const std::vector<std::vector<bool>>& passes,
                   std::uint64_t latency_cycles, const std::optional<DecodeTiming>& decode) {
  Pipeline pipeline(config, latency_cycles, decode);
  for (const auto& share : passes) pipeline.share(share);
  return pipeline.times();
}

}  // namespace sgs::tb
