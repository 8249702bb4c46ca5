// Voxel sorting unit (VSU), exact order: for each pixel group it walks the chunk tree front to back
// and hands out the chunks that can touch the group, each with the depth below which nothing
// follows. Timing: chunk tests on test_lanes lanes, one cycle a queue operation; nodes that its
// cache does not hold wait for DRAM. Function: algorithm/order/chunk_walk.h.
#pragma once

#include <cstdint>
#include <systemc>
#include <vector>

#include "algorithm/order/chunk_walk.h"
#include "modules/streaminggs/finished_groups.h"
#include "modules/streaminggs/messages.h"
#include "modules/streaminggs/unit_context.h"
#include "modules/streaminggs/vsu/exact_vsu_config.h"
#include "modules/streaminggs/vsu/table_cache.h"
#include "tlm/data_sheet.h"
#include "tlm/memory_access.h"

namespace sgs {

class ExactVsu : public sc_core::sc_module {
 public:
  FifoOuts<VisitShare> visits{"visits"};  // one a HFU; visit v goes to v modulo their number
  FinishedGroupsIn finished{"finished"};
  MemoryPort memory;

  SC_HAS_PROCESS(ExactVsu);
  // aside: where in DRAM queue entries wait that do not fit.
  ExactVsu(const sc_core::sc_module_name& name, const ExactVsuConfig& config,
           const UnitContext& context, const RegionSpan& aside);

  struct Counters {
    std::uint64_t visits = 0;            // handed out
    std::uint64_t groups_saturated = 0;  // walks that ended before the tree did
    std::uint64_t groups_empty = 0;      // no chunk touches
  };
  const Counters& counters() const { return counters_; }
  const WalkCounters& walk_counters() const { return chunk_walk_.counters(); }
  std::uint64_t node_misses() const { return nodes_.misses(); }
  static SramUses sram_uses(const ExactVsuConfig& config, const BuiltFor& built_for);
  void publish(DataSheet& sheet);

 private:
  // The tree and the overflow area as the walk sees them: bytes in DRAM.
  class Source {
   public:
    Source(ExactVsu& vsu, const RegionSpan& aside) : vsu_(vsu), aside_(aside) {}
    ChunkNode node(std::uint32_t index);
    void put_aside(const WalkEntry& entry);
    std::vector<WalkEntry> take_back();
    void forget_aside();

   private:
    ExactVsu& vsu_;
    const RegionSpan aside_;
    std::uint32_t aside_count_ = 0;
  };

  void run_walk();  // thread
  std::optional<WalkEntry> next();
  void hand_out(std::uint32_t group, const WalkEntry& chunk, float release_below);
  void mark_end(std::uint32_t group);

  const ExactVsuConfig config_;
  const BuiltFor built_for_;
  const StreamingJob& job_;
  Activity walk_;
  const Datapath tests_;
  TableCache<ChunkNode> nodes_;
  Source source_;
  ChunkWalk<Source> chunk_walk_;
  Counters counters_;
  std::uint32_t next_visit_ = 0;
  std::uint32_t current_group_ = 0, current_chunk_ = 0;  // for the waveform
};

}  // namespace sgs
