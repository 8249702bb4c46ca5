// The whole accelerator: units, FIFOs, router and memory, wired by configuration.
#pragma once

#include <deque>
#include <memory>
#include <string>
#include <systemc>
#include <vector>

#include "algorithm/memory/memory_image.h"
#include "modules/accelerator_config.h"
#include "modules/dram/dram_controller.h"
#include "modules/frame_job.h"
#include "modules/hfu/hfu.h"
#include "modules/merge/merge_unit.h"
#include "modules/rendering/rendering_unit.h"
#include "modules/sorting/key_sorter.h"
#include "modules/sorting/sorting_unit.h"
#include "modules/vsu/chunk_vsu.h"
#include "modules/vsu/vsu.h"
#include "tlm/memory_port.h"
#include "tlm/router.h"
#include "tlm/stall_injector.h"

namespace sgs {

class Accelerator : public sc_core::sc_module {
 public:
  // config is valid; the image's bytes are loaded into the memory at once. stalls (may be null)
  // injects random waits at both sides of every FIFO between units.
  Accelerator(const sc_core::sc_module_name& name, const AcceleratorConfig& config,
              const FrameJob& job, const MemoryImage& image, TimingMode timing,
              StallInjector* stalls);

  // Runs the frame to its end (calls sc_start): until the last pixel lies in DRAM, writes that were
  // answered when they were queued included, and nothing happens any more. Throws
  // std::runtime_error when the simulation stops short of it: units that wait for each other
  // forever.
  void run();

  std::uint64_t frame_cycles() const { return frame_cycles_; }
  std::vector<std::byte> read_frame() const;

  const AcceleratorConfig& config() const { return config_; }
  const FrameJob& job() const { return job_; }
  std::vector<Activity*> activities();
  const std::vector<std::unique_ptr<Hfu>>& hfus() const { return hfus_; }
  // Paper order; null or empty in exact order.
  const Vsu* vsu() const { return vsu_.get(); }
  const std::vector<std::unique_ptr<SortingUnit>>& sorting_units() const { return sorting_; }
  // Exact order; null or empty in paper order.
  const ChunkVsu* chunk_vsu() const { return chunk_vsu_.get(); }
  const std::vector<std::unique_ptr<KeySorter>>& key_sorters() const { return key_sorters_; }
  // Null where second halves are not quantised.
  CodebookBuffer* codebooks() { return codebooks_.get(); }
  const MergeUnit* merge() const { return merge_.get(); }
  const RenderingUnit& rendering() const { return *rendering_; }
  DramController& dram() { return dram_; }
  const std::vector<std::string>& requesters() const { return requesters_; }

  // FIFOs between the units are empty, nothing is in flight.
  bool drained() const;

  void trace(sc_core::sc_trace_file* file) const;

 private:
  // Each wires one ordering and returns the FIFOs that rendering reads.
  std::vector<TimedFifo<SplatToken>*> wire_paper_order();
  std::vector<TimedFifo<SplatToken>*> wire_exact_order();
  std::vector<TimedFifo<VisitShare>*> add_visit_fifos();
  void add_rendering(const std::vector<TimedFifo<SplatToken>*>& splats, Arrival arrival);
  MemoryPort& add_port(const std::string& name);
  template <class T>
  TimedFifo<T>* add_fifo(std::deque<TimedFifo<T>>& fifos, const std::string& name,
                         std::uint32_t entries, std::uint32_t latency_cycles);

  const AcceleratorConfig config_;
  const FrameJob job_;
  const TimingMode timing_;
  StallInjector* const stalls_;
  const ClockDomain clock_;
  SaturationBoard board_;
  PayloadPool pool_;
  DramController dram_;
  Router router_;
  std::vector<std::string> requesters_;
  std::vector<std::unique_ptr<MemoryPort>> ports_;
  std::deque<TimedFifo<VisitShare>> visit_fifos_;   // [HFU]
  std::deque<TimedFifo<SplatToken>> splat_fifos_;   // paper order: [sorting unit, HFU]
  std::deque<TimedFifo<SplatToken>> sorted_fifos_;  // what rendering reads
  std::deque<TimedFifo<FineCandidate>> key_fifos_;  // exact order: to sorting, merge, HFUs
  std::unique_ptr<Vsu> vsu_;
  std::unique_ptr<ChunkVsu> chunk_vsu_;
  std::unique_ptr<CodebookBuffer> codebooks_;
  std::vector<std::unique_ptr<Hfu>> hfus_;
  std::vector<std::unique_ptr<SortingUnit>> sorting_;
  std::vector<std::unique_ptr<KeySorter>> key_sorters_;
  std::unique_ptr<MergeUnit> merge_;
  std::unique_ptr<RenderingUnit> rendering_;
  bool done_ = false;
  std::uint64_t frame_cycles_ = 0;
};

// Bytes that the spill region must have. Paper order: for each sorting unit two copies of the
// largest voxel's splats. Exact order: two runs of all keys, and what VSU's queue puts aside.
std::uint64_t spill_region_bytes(const AcceleratorConfig& config, const VoxelGrid& grid);
std::uint64_t spill_region_bytes(const ChunkTree& tree);

}  // namespace sgs
