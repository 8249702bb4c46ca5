// What the rays of VSU share: lanes, the cache of tree nodes, the ordering table; each free again
// from some cycle on. And the kernel's time, which follows where a cycle matters to somebody else.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "algorithm/order/ordering_table.h"
#include "algorithm/splat/longest_path.h"
#include "modules/streaminggs/vsu/node_fetches.h"
#include "modules/streaminggs/vsu/paper_vsu_config.h"
#include "tlm/activity.h"
#include "tlm/data_sheet.h"

namespace sgs {

class RayUnit {
 public:
  // Cycles from a look-up to the next step or look-up of the ray: tags, line, masks of children. A
  // step is behind the last of these only: its node lies in the context.
  static constexpr std::uint64_t kLookUpCycles = 3, kMaskCycles = 1;

  // The round of each ray that has something to enter is compared with the others', in a tree,
  // before the next can be: from one voxel that is entered to the next, at least. Three levels of
  // comparators a cycle.
  static constexpr std::uint32_t first_of_rounds_cycles(std::uint32_t rays) {
    constexpr std::uint32_t kLevelsOfCycle = 3;
    std::uint32_t levels = 1;
    while ((1U << levels) < rays) ++levels;
    return (levels + kLevelsOfCycle - 1) / kLevelsOfCycle;
  }

  using HandOver = std::function<void(const std::vector<std::uint32_t>& voxels, bool last)>;

  // clock, activity and port outlive it.
  RayUnit(const PaperVsuConfig& config, const OperationLatencies& latencies,
          const ClockDomain& clock, Activity& activity, MemoryPort& port, const RecordArray& nodes,
          HandOver hand_over);

  const PaperVsuConfig config;
  TableCache<VoxelNode> nodes;
  NodeFetches fetches;
  const HandOver hand_over;

  std::uint64_t now() const { return clock_.now_cycles(); }
  void advance_to(std::uint64_t cycle);

  // All is free.
  void begin_pass();

  // Each takes the cycle from which on a ray wants something, and returns when it has it: its
  // beginning, a step, the turn of a look-up, the result of one whose node has come only now.
  std::uint64_t begin_ray(std::uint64_t cycle);
  std::uint64_t step(std::uint64_t cycle, std::uint32_t log2_block);
  std::uint64_t look_up(std::uint64_t cycle);
  std::uint64_t look_up_again(std::uint64_t cycle) { return look_up(cycle) + kLookUpCycles; }

  // Of a line that is not in the cache: asks for it in this cycle if nobody has. Whoever is added
  // waits for it.
  std::vector<NodeFetches::Waiting>& waiting_for(std::uint64_t tag, std::uint64_t cycle);
  // Until the oldest line has come, at the latest until `cycle`; kNever: however long it takes.
  void wait_for_nodes(std::uint64_t cycle);
  // What is still on its way when a pass is given up.
  void take_what_comes();
  static constexpr std::uint64_t kNever = ~std::uint64_t{0};

  // A voxel was added to the table: when it is done.
  std::uint64_t enter(const OrderingTable& table, std::uint64_t cycle);
  // The table has been ordered; it is cleared meanwhile. Or it is cleared because it was full.
  void order(const OrderingTable& table);
  void clear(const OrderingTable& table);

  void met_voxel() { ++met_; }

  static SramUses sram_uses(const PaperVsuConfig& config);
  void publish(DataSheet& sheet) const;
  // To follow the rays of a frame faster: more of what they share, where the cycles that more lanes
  // can take away are more than a third of the time, else more rays.
  Remedy remedy() const;

 private:
  std::uint64_t turn_of(const Datapath& lanes, std::uint64_t& free, std::uint64_t cycle);
  std::uint64_t cycles_since(const OrderingAccesses& all);

  const ClockDomain& clock_;
  Activity& activity_;
  MemoryPort& port_;
  const Datapath begins_, steps_;
  std::uint64_t pass_from_ = 0;
  std::uint64_t begins_free_ = 0, steps_free_ = 0, look_ups_free_ = 0, table_free_ = 0;
  std::uint64_t rays_ = 0, steps_taken_ = 0, met_ = 0, entered_ = 0;
  OrderingAccesses accesses_;                            // of the table so far
  std::uint64_t names_cleared_ = 0, ready_cleared_ = 0;  // words
};

}  // namespace sgs
