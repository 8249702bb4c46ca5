// The time of the merge unit (merge_unit.h) without a kernel: the same heap over the same keys, and
// the same runs of what does not fit.
#pragma once

#include <cstdint>
#include <vector>

#include "algorithm/order/interval_heap.h"
#include "modules/streaminggs/merge/merge_unit.h"
#include "tlm/fifo_times.h"
#include "tlm/port_estimate.h"

namespace sgs {

class MergeEstimate {
 public:
  struct Key {
    float depth = 0;
    std::uint32_t slot = 0;
    std::uint32_t number = 0;  // of its group's keys
    bool operator<(const Key& other) const {
      return depth < other.depth || (depth == other.depth && slot < other.slot);
    }
  };

  MergeEstimate(const MergeConfig& config, std::uint32_t heap_entries, const RegionSpan& spill,
                const PortEstimate& port);

  void begin_group(std::uint32_t group) { port_.charge_to(group); }
  // A key, or a mark, out of the FIFO that it came to before. finished_from: its group, as far as
  // that is known.
  void take(const Key& key, FifoTimes& sorted, std::uint64_t finished_from);
  void take_mark(FifoTimes& sorted, std::uint64_t finished_from);
  // Gives the next key nearer than `nearest`, if there is one and its group is not known to be
  // finished; or, with blend_early, one of more than may wait.
  bool release(float nearest, std::uint64_t finished_from, Key& key);
  bool force_out(std::uint64_t finished_from, Key& key);
  void drop_all();

  std::uint64_t now() const { return now_; }
  // Until it has got rid of what it gave; `works`: of these cycles, which are its own.
  void go_on(std::uint64_t cycle) { now_ = cycle; }
  void work_for(std::uint64_t cycles);
  MergeUnit::Counters& counters() { return work_.counters; }
  MergeUnit::Work work() const;

 private:
  struct Run {
    std::vector<Key> keys;
    std::size_t taken = 0, requested = 0;
    std::uint64_t address = 0;
    const Key& front() const { return keys[taken]; }
    std::size_t left() const { return keys.size() - taken; }
  };
  Key take_nearest();
  void wait_for_heap();
  void spill_farthest();
  void merge_shortest_runs();
  void keep(std::vector<Key> keys);
  void request(Run& run);
  Run* nearest_run();
  void take_front(Run& run);

  const MergeConfig config_;
  const RegionSpan spill_;
  PortEstimate port_;
  IntervalHeap<Key, std::less<Key>> pending_;
  std::vector<Run> runs_;
  std::uint32_t spills_ = 0;  // of this group
  std::uint64_t spill_used_ = 0;
  std::uint64_t now_ = 0, heap_free_ = 0;
  MergeUnit::Work work_;
};

}  // namespace sgs
