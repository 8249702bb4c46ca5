// One reader of several FIFOs: takes from whichever has an entry, in turn.
#pragma once

#include <algorithm>
#include <cstddef>
#include <systemc>
#include <vector>

#include "tlm/timed_fifo.h"

namespace sgs {

template <class T>
class FifoSelector {
 public:
  explicit FifoSelector(std::vector<TimedFifo<T>*> fifos) : fifos_(std::move(fifos)) {
    for (TimedFifo<T>* fifo : fifos_) fifo->announce_to(&arrival_);
  }

  // Blocks until one of the FIFOs for which wanted(index) holds has an entry that is ready, and
  // returns that FIFO's index. Round robin, from the one after the last.
  template <class Wanted>
  std::size_t select(Activity& reader, Wanted&& wanted) {
    while (true) {
      bool any = false;
      sc_core::sc_time earliest;
      for (std::size_t k = 1; k <= fifos_.size(); ++k) {
        const std::size_t index = (last_ + k) % fifos_.size();
        if (!wanted(index) || fifos_[index]->empty()) continue;
        if (fifos_[index]->can_pop()) {
          last_ = index;
          return index;
        }
        const sc_core::sc_time& ready = fifos_[index]->ready_at();
        earliest = any ? std::min(earliest, ready) : ready;
        any = true;
      }
      reader.enter(ActivityState::kStarved);
      if (any) {
        // Whatever arrives meanwhile becomes ready later still, all latencies being equal.
        sc_core::wait(earliest - sc_core::sc_time_stamp());
      } else {
        sc_core::wait(arrival_);
      }
      reader.enter(ActivityState::kBusy);
    }
  }

  TimedFifo<T>& fifo(std::size_t index) { return *fifos_[index]; }
  std::size_t size() const { return fifos_.size(); }

 private:
  std::vector<TimedFifo<T>*> fifos_;
  sc_core::sc_event arrival_;
  std::size_t last_ = 0;
};

}  // namespace sgs
