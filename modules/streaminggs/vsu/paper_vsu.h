// Voxel sorting unit (VSU), paper order. For each pixel group it follows the pixels' rays through
// the voxel tree, or samples them, and orders the voxels that they meet. Each voxel is handed out
// as a visit to the HFUs; one with more Gaussians than a list holds in pieces, the nearest first.
// The next group's pixels are found meanwhile.
// Timing: rays_in_flight.h, ray_unit.h, sampled_rays.h; one cycle a visit and a cut; table misses
// wait for DRAM.
// Function: algorithm/order/group_visits.h, algorithm/voxel/voxel_grid.h.
#pragma once

#include <cstdint>
#include <memory>
#include <systemc>
#include <vector>

#include "algorithm/order/group_visits.h"
#include "modules/datapath/group_numbers.h"
#include "modules/frame_host.h"
#include "modules/streaminggs/finished_groups.h"
#include "modules/streaminggs/messages.h"
#include "modules/streaminggs/unit_context.h"
#include "modules/streaminggs/vsu/paper_vsu_config.h"
#include "modules/streaminggs/vsu/ray_unit.h"
#include "modules/streaminggs/vsu/sampled_rays.h"
#include "modules/streaminggs/vsu/table_cache.h"
#include "tlm/data_sheet.h"
#include "tlm/memory_access.h"
#include "tlm/timed_fifo.h"

namespace sgs {

class PaperVsu : public sc_core::sc_module {
 public:
  FifoOuts<VisitShare> shares{"shares"};   // one a fetch
  FinishedGroupsIns finished{"finished"};  // one for each part of the groups
  FrameHostPort host{"host"};
  MemoryPort node_memory;    // tree nodes, or tables of samples, for the rays
  MemoryPort record_memory;  // voxel records, for the visits

  SC_HAS_PROCESS(PaperVsu);
  PaperVsu(const sc_core::sc_module_name& name, const PaperVsuConfig& config,
           const UnitContext& context);

  struct Counters : CounterSet {
    Counter rays{*this, "rays", "rays", "followed"};
    Counter steps{*this, "steps", "steps", "of rays through the voxel tree"};
    Counter edges{*this, "edges", "edges", "offered to the ordering table"};
    Counter visits{*this, "visits", "voxels", "or pieces of them handed out, once for each group"};
    Counter voxels{*this, "voxels", "voxels", "of these visits, whole or in pieces"};
    Counter cuts{*this, "cuts", "cuts", "of voxels into pieces"};
    Counter visits_saturated{*this, "visits_saturated", "voxels",
                             "left out: the group was finished"};
    Counter groups_empty{*this, "groups_empty", "groups", "with no voxel on any ray"};
    Counter ordering_table_bytes_max{*this, "ordering_table_bytes_max", "bytes",
                                     "ordering table of the worst group"};
    Counter passes{*this, "passes", "passes",
                   "of a group's rays that were ordered, one or more a group"};
    Counter overflows{*this, "overflows", "passes",
                      "of rays begun again because the ordering table was full"};
  };
  const Counters& counters() const { return counters_; }
  static SramUses sram_uses(const PaperVsuConfig& config, const BuiltFor& built_for);
  void publish(DataSheet& sheet);

 private:
  // Voxels that one pass of a group's rays has ordered; most groups take one pass.
  struct OrderedPass {
    std::uint32_t group = 0;
    bool last = true;  // last pass of its group
    std::vector<std::uint32_t> voxels;
  };
  void run_traverse();  // thread: rays to lists of ordered voxels
  void run_arrivals();  // thread: waits for the tree's nodes, where rays follow it
  void run_emit();      // thread: ordered voxels to visits
  ListsOut lists();
  bool take_up_frame(std::uint32_t frame);
  GroupVisits order_group(std::uint32_t group);
  void hand_over(const std::vector<std::uint32_t>& voxels, bool last);
  void visit_voxel(std::uint32_t group, std::uint32_t voxel);
  void hand_out(std::uint32_t group, const VoxelRecord& piece);
  void mark_end(std::uint32_t group);

  const PaperVsuConfig config_;
  const BuiltFor built_for_;
  const StreamingJob& job_;
  Activity traverse_, emit_;
  std::unique_ptr<RayUnit> rays_;         // through the tree
  std::unique_ptr<SampledRays> samples_;  // or sampled: the one or the other
  TableCache<VoxelRecord> records_;
  TableCache<float> cuts_;
  OrderingTable table_;
  GroupNumbersInTurn numbers_in_turn_;
  TimedFifo<OrderedPass> ordered_;
  Counters counters_;
  std::uint64_t cycles_of_full_tables_ = 0, cycles_of_others_ = 0;  // cycles of groups
  std::uint32_t next_visit_ = 0;
  std::uint32_t current_group_ = 0, current_voxel_ = 0;  // for the waveform
};

}  // namespace sgs
