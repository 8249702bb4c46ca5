// The tile-centric machine: units, the FIFOs between them, and its data sheet.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "modules/gscore/ccu/ccu.h"
#include "modules/gscore/culling/chunk_culler.h"
#include "modules/gscore/finished_tiles.h"
#include "modules/gscore/gscore_job.h"
#include "modules/gscore/lists/tile_lister.h"
#include "modules/gscore/rendering/render_core.h"
#include "modules/gscore/sorting/tile_sorter.h"
#include "modules/machine.h"
#include "modules/machine_design.h"
#include "tlm/timed_fifo.h"

namespace sgs::gscore {

// SRAM of the FIFOs between the units.
SramUses queue_uses(const GscoreConfig& config);

class GscoreMachine : public Machine {
 public:
  GscoreMachine(const sc_core::sc_module_name& name, const GscoreConfig& config,
                const GscoreJob& job, const BuildOptions& options);

  const ClockDomain& clock() const override { return clock_; }
  void publish(DataSheet& sheet) override;

 private:
  template <class T>
  using Fifos = std::vector<std::unique_ptr<TimedFifo<T>>>;

  template <class T>
  void add_fifos(Fifos<T>& fifos, const char* name, std::uint32_t count, std::uint32_t entries,
                 std::uint32_t latency_cycles, const BuildOptions& options) {
    for (std::uint32_t k = 0; k < count; ++k) {
      fifos.push_back(std::make_unique<TimedFifo<T>>(fmt::format("{}{}", name, k).c_str(), clock_,
                                                     entries, latency_cycles));
      if (options.stalls.probability > 0) fifos.back()->inject(options.stalls);
    }
  }
  template <class T>
  void publish_queues(DataSheet& sheet, const Fifos<T>& fifos, const char* use, const char* key);
  void add_all_fifos(const BuildOptions& options);
  void make_units();
  UnitContext context() { return {clock_, job_, config_, phases_}; }
  void bind();

  const GscoreConfig config_;
  const GscoreJob job_;
  const ClockDomain clock_;
  Phases phases_;
  Fifos<Pass> passes_;                                    // [CCU], or the culler's
  Fifos<VisibleSlice> visible_;                           // [CCU], where there is a culler
  Fifos<Converted> converted_;                            // [CCU]
  Fifos<TileRequest> requests_;                           // [core]
  Fifos<TileJob> jobs_;                                   // [core]
  Fifos<SortedEntry> sorted_;                             // [core]
  Fifos<PassDone> done_;                                  // [core]
  std::vector<std::unique_ptr<FinishedTiles>> finished_;  // [core]
  std::unique_ptr<ChunkCuller> culler_;                   // null: by Gaussians
  std::vector<std::unique_ptr<Ccu>> ccus_;
  TileLister lister_;
  std::vector<std::unique_ptr<TileSorter>> sorters_;    // [core]
  std::vector<std::unique_ptr<RenderCore>> renderers_;  // [core]
};

}  // namespace sgs::gscore
