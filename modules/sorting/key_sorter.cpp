// The thread of a key sorter.
#include "modules/sorting/key_sorter.h"

#include <algorithm>

#include "modules/sorting/sorting_cost.h"

namespace sgs {

KeySorter::KeySorter(const sc_core::sc_module_name& name, const SortingConfig& config,
                     std::uint32_t first_visit, std::uint32_t visit_step, const ClockDomain& clock,
                     std::vector<TimedFifo<FineCandidate>*> inputs,
                     TimedFifo<FineCandidate>& output)
    : sc_module(name),
      config_(config),
      visit_step_(visit_step),
      inputs_(std::move(inputs)),
      output_(output),
      activity_(this->name(), clock),
      visit_(first_visit) {
  SC_THREAD(run);
}

void KeySorter::run() {
  std::vector<FineCandidate> keys;
  for (;; visit_ += visit_step_) {
    keys.clear();
    FineCandidate key = inputs_[visit_ % inputs_.size()]->pop(activity_);
    while (key.mark == Mark::kNone) {
      activity_.work(1);
      keys.push_back(key);
      key = inputs_[visit_ % inputs_.size()]->pop(activity_);
    }
    std::sort(keys.begin(), keys.end(), [](const FineCandidate& a, const FineCandidate& b) {
      return a.depth < b.depth || (a.depth == b.depth && a.slot < b.slot);
    });
    const SortingCost cost = sort_cost(config_, keys.size());
    activity_.work(cost.cycles);
    ++counters_.visits;
    counters_.visits_trivial += keys.size() < 2 ? 1 : 0;
    counters_.keys += keys.size();
    counters_.compare_exchanges += cost.compare_exchanges;
    for (const FineCandidate& sorted : keys) {
      activity_.work(1);
      output_.push(sorted, activity_);
    }
    output_.push(key, activity_);
  }
}

void KeySorter::trace(sc_core::sc_trace_file* file) const {
  activity_.trace(file);
  sc_core::sc_trace(file, visit_, std::string(name()) + ".visit");
}

}  // namespace sgs
