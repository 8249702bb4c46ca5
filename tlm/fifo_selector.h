// One reader of several FIFOs: takes from whichever has an entry, in turn.
#pragma once

#include <algorithm>
#include <systemc>

#include "tlm/fifo_if.h"

namespace sgs {

// All FIFOs have the same latency, of at least one cycle.
template <class T>
class FifoSelector {
 public:
  // To be made once the ports are bound: by the thread that reads them.
  explicit FifoSelector(FifoIns<T>& fifos) : fifos_(fifos) {
    for (int i = 0; i < fifos.size(); ++i) fifos[i]->announce_to(arrival_);
  }

  // Blocks until one of the FIFOs for which wanted(index) holds has an entry that is ready, and
  // returns that FIFO's index. Round robin, from the one after the last.
  template <class Wanted>
  int select(Activity& reader, Wanted&& wanted) {
    while (true) {
      bool any = false;
      sc_core::sc_time earliest;
      for (int k = 1; k <= fifos_.size(); ++k) {
        const int index = (last_ + k) % fifos_.size();
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
      reader.clock().jitter();
      reader.enter(ActivityState::kBusy);
    }
  }

 private:
  FifoIns<T>& fifos_;
  sc_core::sc_event arrival_;
  int last_ = 0;
};

}  // namespace sgs
