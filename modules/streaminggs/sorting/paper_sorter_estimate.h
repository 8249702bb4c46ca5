// The time of a sorting unit of paper order (paper_sorter.h) without a kernel: the same lists, and
// the same runs of what does not fit. Splats are known by their places in the order of blending.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "modules/streaminggs/sorting/paper_sorter.h"
#include "modules/streaminggs/sorting/sorting_cost.h"
#include "tlm/fifo_times.h"
#include "tlm/port_estimate.h"

namespace sgs {

class PaperSorterEstimate {
 public:
  PaperSorterEstimate(const PaperSorterConfig& config, const PaperSorterPlace& place,
                      const PortEstimate& port);

  void begin_visit(std::uint32_t group) { port_.charge_to(group); }
  // A splat of the visit at hand, or one of the marks behind them, out of the FIFO that it came to
  // before. finished_from: the group, as far as that is known.
  void take(std::uint32_t splat, FifoTimes& splats, std::uint64_t finished_from);
  void take_mark(FifoTimes& splats);
  // All have come: emit(splat, cycle) hands each on and says when it was taken, and may know better
  // then when the group is finished; behind them the mark may go.
  template <class Emit>
  void sort(const std::uint64_t& finished_from, const Emit& emit) {
    end_list();
    if (finished_from > now_) {
      sort_buffer();
      const auto hand_on = [&](std::uint32_t splat) {
        work_for(1);
        ++emitted_;
        now_ = emit(splat, now_);
      };
      if (runs_.empty()) {
        for (const std::uint32_t splat : buffer_) hand_on(splat);
      } else {
        spill_buffer();
        merge_runs(finished_from, hand_on);
      }
    }
    work_.counters.splats_saturated += received_ - emitted_;
    clear();
    work_for(1);
  }
  std::uint64_t now() const { return now_; }
  // Until the mark is taken.
  void go_on(std::uint64_t cycle) { now_ = cycle; }

  PaperSorter::Work work() const;

 private:
  struct Run {
    std::vector<std::uint32_t> splats;
    std::uint64_t address = 0;
    std::size_t written = 0;
  };
  // A run as it is read back, a block ahead.
  struct Reader {
    const Run* run;
    std::size_t requested = 0, taken = 0;
    std::uint64_t answered[2] = {0, 0};
    std::uint32_t current = 0;
    std::uint32_t front() const { return run->splats[taken]; }
    bool exhausted() const { return taken == run->splats.size(); }
  };
  void work_for(std::uint64_t cycles) {
    now_ += cycles;
    work_.sort_cycles += cycles;
  }
  void end_list();
  void clear();
  void sort_buffer();
  void spill_buffer();
  void append(Run& run, std::uint32_t splat);
  void flush(Run& run);
  void request(Reader& reader, std::uint32_t block);
  void load(const Reader& reader);
  void pop(Reader& reader);
  void await_all() { now_ = std::max(now_, port_.all_answered()); }
  std::vector<Reader> begin_merge(const Run* runs, std::size_t count);

  template <class HandOn>
  void merge_runs(const std::uint64_t& finished_from, const HandOn& hand_on) {
    const std::size_t fan_in =
        std::max(2U, config_.buffer_entries / (2 * config_.spill_block_entries));
    std::vector<Run> open = std::move(runs_);
    for (std::uint32_t pass = 1; open.size() > fan_in; ++pass) {
      open = merge_pass(open, fan_in, pass, finished_from);
    }
    merge(open.data(), open.size(), finished_from, hand_on);
  }
  std::vector<Run> merge_pass(const std::vector<Run>& open, std::size_t fan_in, std::uint32_t pass,
                              const std::uint64_t& finished_from);

  // As PaperSorter::merge().
  template <class HandOn>
  void merge(const Run* runs, std::size_t count, const std::uint64_t& finished_from,
             const HandOn& hand_on) {
    std::vector<Reader> readers = begin_merge(runs, count);
    const std::uint64_t cycles = merge_tree_cycles(config_, count, place_.lists_of_network);
    std::uint64_t owed = 0;
    while (!readers.empty() && finished_from > now_) {
      const auto nearest =
          std::min_element(readers.begin(), readers.end(),
                           [](const Reader& a, const Reader& b) { return a.front() < b.front(); });
      owed += cycles;
      work_for(owed / kMergeWidth);
      owed %= kMergeWidth;
      count_merged(count);
      hand_on(nearest->front());
      pop(*nearest);
      if (nearest->exhausted()) readers.erase(nearest);
    }
    await_all();
  }
  void count_merged(std::size_t runs);

  const PaperSorterConfig config_;
  const PaperSorterPlace place_;
  PortEstimate port_;
  std::vector<std::uint32_t> buffer_;
  std::vector<Run> runs_;
  std::uint64_t spill_used_ = 0;
  std::uint64_t received_ = 0, emitted_ = 0;  // splats of this visit
  std::uint64_t now_ = 0;                     // until when it works
  PaperSorter::Work work_;
};

}  // namespace sgs
