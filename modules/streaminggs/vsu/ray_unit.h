// Resources that a group's rays share: lanes, look-ups in the cache of tree nodes, the ordering
// table, each free again from some cycle on; and the tree's nodes, in their cache and on their way
// from DRAM. The kernel's time follows where a cycle matters to another unit.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "algorithm/order/ordering_table.h"
#include "modules/datapath/lane_steps.h"
#include "modules/streaminggs/vsu/node_fetches.h"
#include "modules/streaminggs/vsu/paper_vsu_config.h"
#include "tlm/activity.h"
#include "tlm/data_sheet.h"
#include "tlm/datapath.h"

namespace sgs {

// Receiver of lists of ordered voxels: waits until one can be written, and takes one.
struct ListsOut {
  std::function<void()> wait_for_room;
  std::function<void(const std::vector<std::uint32_t>& voxels, bool last)> hand_over;
};

class RayUnit {
 public:
  // Cycles from a look-up to the next step or look-up of the ray: tags, line, masks of children. A
  // step is behind the last of these only: its node lies in the context.
  static constexpr std::uint64_t kLookUpCycles = 3, kMaskCycles = 1;
  static constexpr std::uint64_t kNever = ~std::uint64_t{0};
  static constexpr std::array<const char*, 5> kMayHelp = {"vsu.rays_in_flight", "vsu.node_fetches",
                                                          "vsu.step_lanes", "vsu.ray_lanes",
                                                          "vsu.table_bytes"};

  // Cycles to find the earliest round, before a voxel is entered or the context of an ended ray is
  // given to another. The rounds of all rays are compared in a tree. The ray found first changes
  // its round, so that the next comparison begins then. Three levels of comparators a cycle.
  static constexpr std::uint32_t first_of_rounds_cycles(std::uint32_t rays) {
    constexpr std::uint32_t kLevelsOfCycle = 3;
    std::uint32_t levels = 1;
    while ((1U << levels) < rays) ++levels;
    return (levels + kLevelsOfCycle - 1) / kLevelsOfCycle;
  }

  // clock, activity and port outlive it.
  RayUnit(const PaperVsuConfig& config, const OperationLatencies& latencies,
          const ClockDomain& clock, Activity& activity, MemoryPort& port, const RecordArray& nodes,
          ListsOut lists);

  const PaperVsuConfig config;
  TableCache<VoxelNode> nodes;
  NodeFetches fetches;
  const ListsOut lists;

  std::uint64_t now() const { return clock_.now_cycles(); }
  void advance_to(std::uint64_t cycle);

  // All is free.
  void begin_pass();

  // Each takes the cycle from which on a ray wants something, and returns when it has it: its
  // beginning, a step, or the turn of a look-up. look_up_called: of one whose line found no place.
  // look_up_again: the result of one whose node has come only now.
  std::uint64_t begin_ray(std::uint64_t cycle);
  std::uint64_t step(std::uint64_t cycle, std::uint32_t log2_block);
  std::uint64_t look_up(std::uint64_t cycle);
  std::uint64_t look_up_called(std::uint64_t cycle) {
    ++counts_.called;
    return look_up(cycle);
  }
  std::uint64_t look_up_again(std::uint64_t cycle) { return look_up(cycle) + kLookUpCycles; }

  // The ray that is the first of all rounds from this cycle on has ended: when its context is given
  // to another.
  std::uint64_t give_context(std::uint64_t cycle);
  // Its voxel was added to the table: when it is done.
  std::uint64_t enter(const OrderingTable& table, std::uint64_t cycle);
  void met_voxel() { ++counts_.met; }
  // A look-up missed, and its line is on its way already, or finds no place.
  void joined() { ++counts_.joined; }
  void found_no_place() { ++counts_.without_place; }

  // Asks in this cycle for a line that is neither in the cache nor on its way. Whoever is added
  // waits for it.
  std::vector<NodeFetches::Waiting>& ask(std::uint64_t tag, std::uint64_t cycle);
  // Waits until the oldest line has come, at the latest until `cycle`; kNever: however long it
  // takes.
  void wait_for_nodes(std::uint64_t cycle);
  // Takes the nodes that are still on their way when a pass is given up.
  void take_what_comes();

  // The table has been ordered; it is cleared meanwhile. Or it is cleared because it was full.
  void order(const OrderingTable& table);
  void clear(const OrderingTable& table);

  static SramUses sram_uses(const PaperVsuConfig& config);
  void publish(DataSheet& sheet) const;
  // Parameter that lets the rays of a frame be followed faster. It is more of a shared resource
  // where more lanes can save more than a third of the time, else more rays.
  Remedy remedy() const;

 private:
  // Operations and accesses of a frame.
  struct Counts {
    std::uint64_t rays = 0, steps = 0, met = 0, entered = 0;
    std::uint64_t joined = 0, without_place = 0;         // look-ups that missed
    std::uint64_t called = 0;                            // look-ups for which there was no place
    std::uint64_t found = 0;                             // first of all rounds
    OrderingAccesses accesses;                           // accesses to the table so far
    std::uint64_t names_cleared = 0, ready_cleared = 0;  // words
  };
  std::uint64_t turn_of(const Datapath& lanes, std::uint64_t& free, std::uint64_t cycle);
  // Cycle from which on a ray is the first: when the tree has found it.
  std::uint64_t found(std::uint64_t cycle);

  const ClockDomain& clock_;
  Activity& activity_;
  MemoryPort& port_;
  const Datapath begins_, steps_;
  std::uint64_t pass_from_ = 0;
  std::uint64_t begins_free_ = 0, steps_free_ = 0, look_ups_free_ = 0, tree_free_ = 0,
                table_free_ = 0;
  std::uint64_t written_ = 0;  // until when the table writes the voxel that it found last
  Counts counts_;
};

// Memories of the ordering table beside it: names of voxels, words of ready ones.
constexpr std::uint32_t kNameBytes = 2;  // the number of a voxel
constexpr std::uint32_t kNamesWord = 8;
constexpr std::uint32_t kReadyWord = 4;
std::uint64_t names_bytes(const PaperVsuConfig& config);
std::uint64_t ready_words(const PaperVsuConfig& config);

}  // namespace sgs
