// The rays' turns at what they share, and the tree's nodes on their way (ray_unit.h), without a
// kernel.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <vector>

#include "algorithm/voxel/voxel_grid.h"
#include "modules/streaminggs/vsu/node_fetches.h"
#include "modules/streaminggs/vsu/ray_turns.h"
#include "modules/streaminggs/vsu/table_cache.h"
#include "tlm/port_estimate.h"

namespace sgs {

// As NodeFetches, of lines whose answers are known when they are asked for.
class NodeFetchTimes {
 public:
  using Waiting = NodeFetches::Waiting;
  using Fetch = NodeFetches::Fetch;

  // now: of the unit that they belong to.
  explicit NodeFetchTimes(const std::uint64_t& now) : now_(now) {}

  bool empty() const { return fetches_.empty(); }
  std::size_t size() const { return fetches_.size(); }
  std::vector<Waiting>* waiting_for(std::uint64_t tag);
  Fetch& ask() { return fetches_.emplace_back(); }
  // Of the line that was asked for last; it is not there before those that were asked for before.
  void answered(std::uint64_t cycle);
  bool any_come() const { return !ready_.empty() && comes() <= now_; }
  // The oldest is there, and can be taken the cycle after.
  std::uint64_t comes() const { return ready_.front() - 1; }
  std::uint64_t ready_cycle() const { return ready_.front(); }
  Fetch take();

 private:
  const std::uint64_t& now_;
  std::deque<Fetch> fetches_;
  std::deque<std::uint64_t> ready_;
  std::uint64_t ready_from_ = 0;  // of the line that comes last; one a cycle
};

class RayUnitEstimate : public RayTurns {
 public:
  // table: of these nodes, in the memory behind the port.
  RayUnitEstimate(const PaperVsuConfig& config, const OperationLatencies& latencies,
                  const RecordArray& table, const std::vector<VoxelNode>& nodes,
                  const PortEstimate& port, ListsOut lists);

  TableCache<VoxelNode> nodes;
  NodeFetchTimes fetches{now_};
  const ListsOut lists;

  std::uint64_t now() const { return now_; }
  void advance_to(std::uint64_t cycle) { works_until(std::max(now_, cycle)); }
  // Waits, for what is not its own doing.
  void go_on(std::uint64_t cycle) { now_ = std::max(now_, cycle); }
  void charge_to(std::uint32_t group) { port_.charge_to(group); }

  // As those of RayUnit.
  void begin_pass() { free_from(now_); }
  std::vector<NodeFetches::Waiting>& ask(std::uint64_t tag, std::uint64_t cycle);
  void wait_for_nodes(std::uint64_t cycle);
  void take_what_comes();
  void order(const OrderingTable& table) { works_until(now_ + order_cycles(table)); }
  void clear(const OrderingTable& table) { works_until(now_ + clear_cycles(table)); }

  std::uint64_t busy_cycles() const { return busy_; }
  const PortTraffic& traffic() const { return port_.traffic(); }

 private:
  void works_until(std::uint64_t cycle) {
    busy_ += cycle - now_;
    now_ = cycle;
  }

  const std::vector<VoxelNode>& tree_;
  PortEstimate port_;
  std::uint64_t now_ = 0, busy_ = 0;
};

}  // namespace sgs
