// One reader of several FIFOs: takes from whichever has an entry, in turn.
#pragma once

#include <systemc>

#include "tlm/fifo_if.h"

namespace sgs {

// All FIFOs have the same latency, of at least one cycle.
template <class T>
class FifoSelector {
 public:
  // Made once the ports are bound: by the thread that reads them.
  explicit FifoSelector(FifoIns<T>& fifos) : fifos_(fifos) {
    for (int i = 0; i < fifos.size(); ++i) fifos[i]->announce_to(arrival_);
  }

  // Blocks until one of the FIFOs for which wanted(index) holds, at least one, has an entry that is
  // ready, and returns that FIFO's index. Round robin, from the one after the last. Waiting is
  // charged to the FIFO that is returned: which of several has its entry first may depend on the
  // order of processes, which of them is taken does not.
  template <class Wanted>
  int select(Activity& reader, Wanted&& wanted) {
    bool waiting = false;
    while (true) {
      int soonest = -1, next = -1;
      for (int k = 1; k <= fifos_.size(); ++k) {
        const int index = (last_ + k) % fifos_.size();
        if (!wanted(index)) continue;
        if (next < 0) next = index;
        if (fifos_[index]->empty()) continue;
        if (fifos_[index]->can_pop()) {
          if (waiting) {
            reader.waits_at(fifos_[index]->place());
            reader.works();
          }
          last_ = index;
          return index;
        }
        if (soonest < 0 || fifos_[index]->ready_at() < fifos_[soonest]->ready_at()) soonest = index;
      }
      if (!waiting) reader.waits_for(WaitFor::kInput, fifos_[next]->place());
      waiting = true;
      if (soonest >= 0) {
        // Whatever arrives meanwhile becomes ready later still, all latencies being equal.
        sc_core::wait(fifos_[soonest]->ready_at() - sc_core::sc_time_stamp());
      } else {
        sc_core::wait(arrival_);
      }
      reader.clock().jitter();
    }
  }

 private:
  FifoIns<T>& fifos_;
  sc_core::sc_event arrival_;
  int last_ = 0;
};

}  // namespace sgs
