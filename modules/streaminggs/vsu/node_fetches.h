// Lines of tree nodes on their way from DRAM, and the rays that wait for each. They come out in the
// order in which they were asked for.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <systemc>
#include <utility>
#include <vector>

#include "algorithm/voxel/voxel_grid.h"
#include "modules/streaminggs/vsu/table_cache.h"
#include "tlm/memory_access.h"

namespace sgs {

// Two threads of one unit: one asks and takes, the other waits for the memory. A line can be taken
// the cycle after it has come, so that it does not matter which of them the kernel runs first.
class NodeFetches {
 public:
  using Cache = TableCache<VoxelNode>;
  struct Waiting {
    std::uint32_t ray, node;
  };
  struct Fetch {
    Cache::Line line;
    std::vector<Waiting> waiting;
  };

  bool empty() const { return fetches_.empty(); }
  std::size_t size() const { return fetches_.size(); }

  // The rays that wait for a line that has been asked for; null where it has not.
  std::vector<Waiting>* waiting_for(std::uint64_t tag) {
    for (Fetch& fetch : fetches_) {
      if (fetch.line.tag == tag) return &fetch.waiting;
    }
    return nullptr;
  }
  std::vector<Waiting>& ask(std::uint64_t tag, Cache& cache, MemoryPort& port, Activity& activity) {
    Fetch& fetch = fetches_.emplace_back();
    asked_.push_back(cache.fetch(tag, fetch.line, port, activity));
    asked_for_.notify(sc_core::SC_ZERO_TIME);
    return fetch.waiting;
  }

  // The oldest has come, and from which cycle on it can be taken.
  bool any_come() const { return !ready_.empty(); }
  std::uint64_t ready_cycle() const { return ready_.front(); }
  Fetch take() {
    Fetch fetch = std::move(fetches_.front());
    fetches_.pop_front();
    ready_.pop_front();
    return fetch;
  }
  // Notified when one has come.
  const sc_core::sc_event& news() const { return news_; }

  // Body of the thread that waits for the memory.
  void run_arrivals(MemoryPort& port, const ClockDomain& clock) {
    while (true) {
      while (asked_.empty()) sc_core::wait(asked_for_);
      port.wait_for(asked_.front());
      asked_.pop_front();
      clock.align();
      ready_from_ = std::max(ready_from_, clock.now_cycles()) + 1;
      ready_.push_back(ready_from_);
      news_.notify(sc_core::SC_ZERO_TIME);
    }
  }

 private:
  std::deque<Fetch> fetches_;  // the port writes into their lines
  std::deque<MemoryPort::Ticket> asked_;
  std::deque<std::uint64_t> ready_;
  std::uint64_t ready_from_ = 0;  // cycle from which the last line is there; one a cycle
  sc_core::sc_event asked_for_, news_;
};

}  // namespace sgs
