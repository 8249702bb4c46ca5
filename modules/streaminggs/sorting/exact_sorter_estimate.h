// The time of a sorting unit of exact order (exact_sorter.h) without a kernel.
#pragma once

#include <cstdint>

#include "modules/streaminggs/sorting/exact_sorter.h"
#include "modules/streaminggs/sorting/sorting_cost.h"
#include "tlm/fifo_times.h"

namespace sgs {

class ExactSorterEstimate {
 public:
  explicit ExactSorterEstimate(const SortingNetworkConfig& config) : config_(config) {}

  // A key of the visit at hand, out of the FIFO that it came to before.
  void take(FifoTimes& keys) {
    now_ = keys.pop(now_) + 1;
    ++work_.sort_cycles;
    ++list_;
  }
  // The mark behind them: they are sorted.
  void sort(FifoTimes& keys) {
    now_ = keys.pop(now_);
    const SortingCost cost = sort_cost(config_, list_);
    now_ += cost.cycles;
    work_.sort_cycles += cost.cycles;
    ++work_.counters.visits;
    work_.counters.visits_trivial += list_ == 1 ? 1 : 0;
    work_.counters.keys += list_;
    work_.counters.compare_exchanges += cost.compare_exchanges;
    work_.counters.moves += cost.moves;
    list_ = 0;
  }
  // The next of them, or the mark, goes on.
  void hand_on(FifoTimes& sorted) {
    now_ = sorted.push(now_ + 1);
    ++work_.sort_cycles;
  }
  const ExactSorter::Work& work() const { return work_; }

 private:
  const SortingNetworkConfig config_;
  std::uint64_t list_ = 0;  // keys of the visit at hand
  std::uint64_t now_ = 0;   // until when it works
  ExactSorter::Work work_;
};

}  // namespace sgs
