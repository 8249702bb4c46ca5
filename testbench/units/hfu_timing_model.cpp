// The recurrences. Each vector holds a time for each of the things that pass one place in order;
// "at least k ago" is what a buffer of k places demands.
#include "testbench/units/hfu_timing_model.h"

#include <algorithm>

#include "modules/streaminggs/hfu/codebook_config.h"
#include "modules/streaminggs/hfu/filter_datapaths.h"
#include "tlm/memory_port.h"

namespace sgs::tb {
namespace {

using Cycle = std::uint64_t;

// Time of the entry `places` before the next one, 0 while there is none.
Cycle before(const std::vector<Cycle>& times, std::size_t places) {
  return times.size() < places ? 0 : times[times.size() - places];
}

// Cycles from the first to the last transaction of so many records.
Cycle port_cycles(const RecordArray& records, std::uint64_t first, std::size_t count) {
  const std::uint64_t longest = MemoryPortConfig{}.max_transaction_bytes;
  const std::uint64_t begin = records.address(first), end = records.address(first + count);
  return (end - 1) / longest - begin / longest;
}

class Pipeline {
 public:
  Pipeline(const HfuConfig& config, CoarseBoundBy bound_by, Cycle latency,
           std::optional<std::uint32_t> decode_latency)
      : config_(config),
        has_cfus_(has_cfus(config, bound_by)),
        latency_(latency),
        decode_latency_(decode_latency) {}

  void share(const TimedShare& share) {
    share_ = &share;
    times_.tested.emplace_back(share.passes.size(), false);
    loaded_ = std::max(loaded_, Cycle{1});  // input latency at the start
    std::size_t end = share.passes.size();
    if (finished(loaded_)) {
      times_.dropped += end;
      end = 0;
    }
    std::size_t at = 0;
    do {
      const std::size_t count = std::min<std::size_t>(end - at, config_.slice_gaussians);
      const Cycle data = load(at, count);
      coarse_ = std::max(coarse_, loaded_ + 1);  // FIFO of slices
      slice_taken_.push_back(coarse_);
      if (count > 0) filter(at, count, data, at + count == end);
      half_free_.push_back(coarse_);
      at += count;
    } while (at < end);
    coarse_ = place(coarse_) + 1;  // the mark
    ++times_.coarse_busy;
    candidate(nullptr);
    times_.shares_done.push_back(fine_);
  }

  const HfuTimes& times() const { return times_; }

 private:
  bool finished(Cycle now) const { return share_->finished_from <= now; }

  // Returns when the slice's bytes are there.
  Cycle load(std::size_t at, std::size_t count) {
    loaded_ = std::max(loaded_, before(half_free_, config_.input_slots));
    Cycle data = 0;
    ++loaded_;
    if (count > 0) {
      loaded_ += port_cycles(share_->first_halves, share_->first + at, count);
      data = loaded_ + latency_;
      times_.first_halves += count;
    }
    loaded_ = std::max(loaded_, before(slice_taken_, config_.input_slots));
    return data;
  }

  // last: of its share, so that a mark follows.
  void filter(std::size_t at, std::size_t count, Cycle data, bool last) {
    coarse_ = std::max(coarse_, data);
    // A first half is read a cycle; each CFU begins when it is its turn, the first in cycle 0.
    const Cycle cfus = has_cfus_ ? config_.cfus : 1;
    const Cycle of_test = has_cfus_ ? config_.cfu_interval_cycles() : 1;
    Cycle interval = of_test;
    while (interval < cfus) interval += of_test;
    const Cycle began = coarse_;
    Cycle owed = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (i % config_.cfus == 0) {
        if (finished(coarse_)) {
          times_.dropped += count - i;
          break;
        }
      }
      if (place(coarse_ + owed) > coarse_ + owed) {
        spend(owed);
        coarse_ = place(coarse_);
      }
      for (; (coarse_ + owed) % interval >= cfus; ++owed) ++times_.coarse_turns;
      ++owed;
      times_.coarse_tests += config_.coarse_filter ? 1 : 0;
      if (!share_->passes[at + i]) {
        failed_leave_.push_back(coarse_ + owed + config_.cfu_depth_cycles);
        continue;
      }
      spend(owed);
      ++times_.coarse_passed;
      const std::size_t gaussian = at + i;
      candidate(&gaussian);
    }
    if (coarse_ + owed == began && !last) ++owed;
    spend(owed);
  }

  // The first cycle from `now` on with a place behind the CFUs, beside what is under test and will
  // not pass.
  Cycle place(Cycle now) const {
    for (;; ++now) {
      std::size_t held = 0;
      for (const Cycle cycle : candidate_taken_) held += cycle > now ? 1 : 0;
      for (const Cycle cycle : failed_leave_) held += cycle > now ? 1 : 0;
      if (held < config_.candidate_fifo_entries) return now;
    }
  }

  void spend(Cycle& owed) {
    coarse_ += owed;
    times_.coarse_busy += owed;
    owed = 0;
  }

  // From the coarse filter to sorting. gaussian: its place in the share; null: a mark.
  void candidate(const std::size_t* gaussian) {
    fetch_ = std::max(fetch_, coarse_ + config_.cfu_depth_cycles);
    candidate_taken_.push_back(fetch_);
    if (gaussian != nullptr && finished(fetch_)) {
      ++times_.dropped;
      ++fetch_;
      return;
    }
    Cycle data = 0;
    if (gaussian != nullptr) {
      fetch_ = std::max(fetch_, before(slot_free_, config_.second_half_slots)) + 1;
      fetch_ += port_cycles(share_->second_halves, share_->first + *gaussian, 1);
      data = fetch_ + latency_;
      ++times_.second_halves;
    } else {
      ++fetch_;
    }
    fetch_ = std::max(fetch_, before(fetched_taken_, config_.second_half_slots + 1));
    if (decode_latency_) {
      decode(gaussian, data);
    } else {
      take(gaussian, data);
    }
  }

  // The decode stage; what it has in hand stays in the FIFO behind the fetches until it is done.
  void decode(const std::size_t* gaussian, Cycle data) {
    decode_ = std::max({decode_, fetch_ + 1, data, before(decoded_taken_, kDecodedEntries)});
    if (gaussian != nullptr && !finished(decode_)) {
      read_lines(share_->lines[*gaussian]);
    } else {
      ++decode_;
      ++times_.decode_busy;
    }
    if (gaussian != nullptr) slot_free_.push_back(decode_);
    fetched_taken_.push_back(decode_);
    const Cycle there = decode_ + *decode_latency_;
    fine_ = std::max(fine_, there);
    if (gaussian == nullptr) {
      decoded_taken_.push_back(fine_);
      pass_mark();
      return;
    }
    fine_ = std::max(fine_, lanes_);
    const bool wanted = wait_for_turn();
    decoded_taken_.push_back(fine_);
    test(*gaussian, wanted);
  }

  // The FFU itself, straight from the slots.
  void take(const std::size_t* gaussian, Cycle data) {
    fine_ = std::max(fine_, fetch_ + 1);
    if (gaussian == nullptr) {
      fetched_taken_.push_back(fine_);
      pass_mark();
      return;
    }
    fine_ = std::max({fine_, lanes_, data});
    const bool wanted = wait_for_turn();
    slot_free_.push_back(fine_ + read_cycles());
    fetched_taken_.push_back(fine_);
    test(*gaussian, wanted);
  }

  // Beside what the lanes do.
  void pass_mark() {
    times_.fine_busy += fine_ < lanes_ ? 0 : 1;
    ++fine_;
  }

  // A record, a word of the port's width a cycle.
  Cycle read_cycles() const {
    return (share_->second_halves.record_bytes + kPortBytes - 1) / kPortBytes;
  }

  void read_lines(Cycle lines) {
    decode_ += lines;
    times_.decode_busy += lines;
    times_.lines += lines;
    ++times_.decoded;
  }

  // False for what a finished group does not want: it takes no turn.
  bool wait_for_turn() {
    if (finished(fine_)) return false;
    while (fine_ % config_.ffu_interval_cycles() != 0) {
      ++fine_;
      ++times_.fine_busy;
      ++times_.fine_turns;
    }
    return true;
  }

  void test(std::size_t gaussian, bool wanted) {
    if (!wanted) {
      ++times_.dropped;
      ++fine_;
      ++times_.fine_busy;
      return;
    }
    const Cycle of_test =
        std::max<Cycle>(config_.ffu_interval_cycles(), decode_latency_ ? 0 : read_cycles());
    lanes_ = fine_ + of_test;
    ++fine_;
    times_.fine_busy += of_test;
    times_.tested.back()[gaussian] = true;
    ++times_.fine_tests;
  }

  const HfuConfig& config_;
  const bool has_cfus_;
  const Cycle latency_;
  const std::optional<std::uint32_t> decode_latency_;
  const TimedShare* share_ = nullptr;
  // When each thread is free, the FFU's for a mark.
  Cycle loaded_ = 0, coarse_ = 0, fetch_ = 0, decode_ = 0, fine_ = 0;
  std::vector<Cycle> failed_leave_;  // what did not pass leaves the CFUs
  std::vector<Cycle> half_free_, slice_taken_, candidate_taken_, fetched_taken_, slot_free_,
      decoded_taken_;
  Cycle lanes_ = 0;  // when they are free
  HfuTimes times_;
};

}  // namespace

HfuTimes hfu_times(const HfuConfig& config, CoarseBoundBy bound_by,
                   const std::vector<TimedShare>& shares, std::uint64_t latency_cycles,
                   std::optional<std::uint32_t> decode_latency_cycles) {
  Pipeline pipeline(config, bound_by, latency_cycles, decode_latency_cycles);
  for (const TimedShare& share : shares) pipeline.share(share);
  return pipeline.times();
}

}  // namespace sgs::tb
