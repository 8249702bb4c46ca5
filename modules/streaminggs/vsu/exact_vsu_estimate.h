// The time of the exact VSU (exact_vsu.h) without a kernel, node by node and chunk by chunk of what
// the golden walk opened and gave. Nodes are read in the order of that walk as far as they are
// known by then, ahead of need and of the next group too, while the buffers and the queue of chunks
// have room; the queues' operations share their time with each other. Not in it: entries put aside.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <queue>
#include <utility>
#include <vector>

#include "algorithm/memory/regions.h"
#include "algorithm/render/exact_work.h"
#include "modules/streaminggs/vsu/exact_vsu.h"
#include "tlm/booked_time.h"
#include "tlm/fifo_times.h"
#include "tlm/port_estimate.h"

namespace sgs {

class ExactVsuEstimate {
 public:
  // Whether all sub-tiles of a reach are known to be finished in a cycle.
  using Hidden = std::function<bool(const GroupReach&, std::uint64_t)>;

  ExactVsuEstimate(const ExactVsuConfig& config, const Datapath& lanes, const RecordArray& table,
                   const std::vector<ExactGroupWork>& groups, const PortEstimate& port,
                   Hidden hidden);

  // The next one.
  void begin_group();
  // The cycle in which the walk has taken the group's next chunk.
  std::uint64_t take_chunk(const VisitWork& chunk);
  bool hidden(const VisitWork& chunk, std::uint64_t cycle);
  // A visit or the end of the group, from the walk on in `now`: the cycle in which it is ready for
  // the HFUs, and that in which they took it.
  std::uint64_t give(std::uint64_t now);
  void given(std::uint64_t cycle) { hand_out_ = cycle; }
  void end_group(std::uint64_t now, bool saturated);
  void count_visit(bool dropped) {
    ++(dropped ? work_.counters.visits_dropped : work_.counters.visits);
  }

  // What was done so far.
  ExactVsu::Work work() const;
  std::uint64_t entries_given() const { return ready_.pushed(); }

 private:
  template <class T>
  using Smallest = std::priority_queue<T, std::vector<T>, std::greater<T>>;
  struct Node {
    bool read = false, left_out = false;
    std::uint64_t entered = 0;                      // the cycle in which its children are known
    std::uint32_t first_child = 0, next_child = 0;  // of its parent's; 0: none
  };
  struct Walk {
    std::uint32_t group = 0;
    const ExactGroupWork* work = nullptr;
    std::vector<Node> nodes;
    Smallest<std::pair<std::uint64_t, std::uint32_t>> coming;  // (known from, node)
    Smallest<std::uint32_t> known;
    std::size_t read = 0;       // nodes before it all are
    std::size_t open = 0;       // of these, that the chunk at hand waited for
    std::uint64_t entered = 0;  // the last of them
  };
  void begin_walk(std::uint64_t cycle);
  void read_next();
  void read(Walk& walk, std::uint32_t number, std::uint64_t cycle);
  void leave_out_below(Walk& walk, std::uint32_t number);
  bool leave_out(const Walk& walk, const NodeWork& node, std::uint64_t cycle);
  std::uint64_t test(const NodeWork& node, std::uint64_t put);
  bool has_room(const Walk& walk, std::uint64_t cycle) const;
  void look_around(std::uint64_t cycle);
  std::uint64_t queue_cycles(std::uint64_t operations) const;

  const ExactVsuConfig config_;
  const Datapath lanes_;
  const RecordArray table_;
  PortEstimate port_;
  const Hidden hidden_;
  BookedTime walk_;
  FifoTimes ready_;
  std::vector<std::uint64_t> room_;       // ring: when the walk knows of room in `ready_`
  std::vector<std::uint64_t> fetched_;    // ring: when the last nodes in flight left their slots
  std::vector<std::uint64_t> tested_;     // ring: when the last nodes in test did
  std::uint64_t fetches_ = 0, puts_ = 0;  // so far
  const std::vector<ExactGroupWork>& groups_;
  std::uint32_t next_group_ = 0;              // whose walk has not begun
  std::deque<Walk> walks_;                    // at most two, the first is of the group at hand
  std::vector<std::uint64_t> final_, taken_;  // [chunk] of the frame, when
  // What the walk has before it in the cycle that was looked at last.
  struct Opening {
    std::uint64_t entered = 0;
    std::uint32_t chunks = 0;  // of its children
    std::uint32_t group = 0;
  };
  std::deque<Opening> opening_;     // nodes that were read, and are not open
  std::uint64_t chunks_known_ = 0;  // so far, but for those that were dropped with their group
  std::uint64_t chunks_taken_ = 0;  // of `taken_`
  std::uint64_t last_read_ = 0, last_put_ = 0, last_take_ = 0;
  std::uint64_t ended_ = 0;  // the group before that at hand
  std::uint64_t tests_free_ = 0, test_busy_ = 0, hand_out_ = 0, handed_out_ = 0;
  ExactVsu::Work work_;
};

}  // namespace sgs
