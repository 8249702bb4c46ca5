// Voxel sorting unit (VSU), paper order: for each pixel group it follows the pixels' rays through
// the voxel tree, orders the voxels that they meet, and hands each out as a visit to the HFUs.
// Timing: steps / steps_per_cycle + edges / edges_per_cycle a ray, one cycle a voxel and edge to
// order them, one cycle a visit; table misses wait for DRAM. Function:
// algorithm/order/group_visits.h.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <systemc>
#include <vector>

#include "algorithm/order/group_visits.h"
#include "modules/frame_job.h"
#include "modules/messages.h"
#include "modules/saturation_board.h"
#include "modules/vsu/table_cache.h"
#include "modules/vsu/vsu_config.h"
#include "tlm/memory_access.h"
#include "tlm/timed_fifo.h"

namespace sgs {

struct VsuCounters {
  std::uint64_t rays = 0, steps = 0, edges = 0;
  std::uint64_t visits = 0;            // handed out
  std::uint64_t visits_saturated = 0;  // left out: the group was finished
  std::uint64_t groups_empty = 0;      // no voxel on any ray
  std::uint64_t table_bytes_max = 0;   // ordering table of the worst group
  std::uint64_t node_misses = 0, record_misses = 0;
};

class Vsu : public sc_core::sc_module {
 public:
  SC_HAS_PROCESS(Vsu);
  // shares: one FIFO a HFU.
  Vsu(const sc_core::sc_module_name& name, const VsuConfig& config, const ClockDomain& clock,
      const FrameJob& job, const SaturationBoard& board, MemoryPort& port,
      std::vector<TimedFifo<VisitShare>*> shares);

  const VsuCounters& counters() const { return counters_; }
  const Activity& traverse_activity() const { return traverse_activity_; }
  std::array<Activity*, 2> activities() { return {&traverse_activity_, &emit_activity_}; }
  void trace(sc_core::sc_trace_file* file) const;

 private:
  struct OrderedGroup {
    std::uint32_t group = 0;
    std::vector<std::uint32_t> voxels;
  };
  void traverse();  // thread: rays to ordered voxels, some groups ahead
  void emit();      // thread: ordered voxels to visits
  GroupVisits order_group(const PixelRect& pixels);
  void hand_out(std::uint32_t group, const VoxelRecord& voxel);
  void mark_end(std::uint32_t group);

  const VsuConfig config_;
  const FrameJob& job_;
  const SaturationBoard& board_;
  MemoryPort& port_;
  std::vector<TimedFifo<VisitShare>*> shares_;
  Activity traverse_activity_, emit_activity_;
  TableCache<VoxelNode> nodes_;
  TableCache<VoxelRecord> records_;
  OrderingTable table_;
  TimedFifo<std::shared_ptr<OrderedGroup>> ordered_;
  VsuCounters counters_;
  std::uint32_t next_visit_ = 0;
  std::uint32_t current_group_ = 0, current_voxel_ = 0;  // for the waveform
};

}  // namespace sgs
