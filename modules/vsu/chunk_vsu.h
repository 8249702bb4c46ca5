// Voxel sorting unit (VSU), exact order: for each pixel group it walks the chunk tree front to back
// and hands out the chunks that can touch the group, each with the depth below which nothing
// follows. Timing: tests_per_cycle children a cycle, one cycle a queue operation; nodes that its
// cache does not hold wait for DRAM. Function: algorithm/order/chunk_walk.h.
#pragma once

#include <array>
#include <cstdint>
#include <systemc>
#include <vector>

#include "algorithm/order/chunk_walk.h"
#include "modules/frame_job.h"
#include "modules/messages.h"
#include "modules/saturation_board.h"
#include "modules/vsu/table_cache.h"
#include "modules/vsu/vsu_config.h"
#include "tlm/memory_access.h"
#include "tlm/timed_fifo.h"

namespace sgs {

struct ChunkVsuCounters {
  std::uint64_t nodes = 0;             // opened
  std::uint64_t node_misses = 0;       // read from DRAM
  std::uint64_t tests = 0;             // of children against the group
  std::uint64_t visits = 0;            // handed out
  std::uint64_t groups_saturated = 0;  // walks that ended before the tree did
  std::uint64_t groups_empty = 0;      // no chunk touches
  std::uint64_t queue_max = 0;         // entries
  std::uint64_t overflowed = 0;        // entries put aside in DRAM
};

class ChunkVsu : public sc_core::sc_module {
 public:
  SC_HAS_PROCESS(ChunkVsu);
  // visits: one FIFO a HFU; visit v goes to v modulo their number. aside_base: where in DRAM queue
  // entries wait that do not fit.
  ChunkVsu(const sc_core::sc_module_name& name, const VsuConfig& config, const ClockDomain& clock,
           const FrameJob& job, const SaturationBoard& board, MemoryPort& port,
           std::vector<TimedFifo<VisitShare>*> visits, std::uint64_t aside_base);

  ChunkVsuCounters counters() const;
  const Activity& walk_activity() const { return walk_activity_; }
  std::array<Activity*, 1> activities() { return {&walk_activity_}; }
  void trace(sc_core::sc_trace_file* file) const;

 private:
  // The tree and the overflow area as the walk sees them: bytes in DRAM.
  class Source {
   public:
    Source(ChunkVsu& vsu, std::uint64_t aside_base) : vsu_(vsu), aside_base_(aside_base) {}
    ChunkNode node(std::uint32_t index);
    void put_aside(const WalkEntry& entry);
    std::vector<WalkEntry> take_back();
    void forget_aside();

   private:
    ChunkVsu& vsu_;
    const std::uint64_t aside_base_;
    std::uint32_t aside_count_ = 0;
  };

  void walk();  // thread
  std::optional<WalkEntry> next();
  void hand_out(std::uint32_t group, const WalkEntry& chunk, float release_below);
  void mark_end(std::uint32_t group);

  const VsuConfig config_;
  const FrameJob& job_;
  const SaturationBoard& board_;
  MemoryPort& port_;
  std::vector<TimedFifo<VisitShare>*> visits_;
  Activity walk_activity_;
  TableCache<ChunkNode> nodes_;
  Source source_;
  ChunkWalk<Source> chunk_walk_;
  ChunkVsuCounters counters_;
  std::uint32_t next_visit_ = 0;
  std::uint32_t current_group_ = 0, current_chunk_ = 0;  // for the waveform
};

}  // namespace sgs
