// The rays' turns at what they share (ray_turns.h) in the kernel's time, which follows where a
// cycle matters to somebody else; and the tree's nodes, in their cache and on their way from DRAM.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "modules/streaminggs/vsu/node_fetches.h"
#include "modules/streaminggs/vsu/ray_turns.h"
#include "tlm/activity.h"
#include "tlm/data_sheet.h"

namespace sgs {

class RayUnit : public RayTurns {
 public:
  // clock, activity and port outlive it.
  RayUnit(const PaperVsuConfig& config, const OperationLatencies& latencies,
          const ClockDomain& clock, Activity& activity, MemoryPort& port, const RecordArray& nodes,
          ListsOut lists);

  TableCache<VoxelNode> nodes;
  NodeFetches fetches;
  const ListsOut lists;

  std::uint64_t now() const { return clock_.now_cycles(); }
  void advance_to(std::uint64_t cycle);

  // All is free.
  void begin_pass();

  // Asks in this cycle for a line that is neither in the cache nor on its way. Whoever is added
  // waits for it.
  std::vector<NodeFetches::Waiting>& ask(std::uint64_t tag, std::uint64_t cycle);
  // Until the oldest line has come, at the latest until `cycle`; kNever: however long it takes.
  void wait_for_nodes(std::uint64_t cycle);
  // What is still on its way when a pass is given up.
  void take_what_comes();

  // The table has been ordered; it is cleared meanwhile. Or it is cleared because it was full.
  void order(const OrderingTable& table) { activity_.work(order_cycles(table)); }
  void clear(const OrderingTable& table) { activity_.work(clear_cycles(table)); }

  static SramUses sram_uses(const PaperVsuConfig& config);
  void publish(DataSheet& sheet) const;
  // To follow the rays of a frame faster: more of what they share, where the cycles that more lanes
  // can take away are more than a third of the time, else more rays.
  Remedy remedy() const;

 private:
  const ClockDomain& clock_;
  Activity& activity_;
  MemoryPort& port_;
};

}  // namespace sgs
