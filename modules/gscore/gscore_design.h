// The design of the tile-centric machine.
#pragma once

#include "modules/gscore/gscore_config.h"
#include "modules/gscore/gscore_job.h"
#include "modules/machine_design.h"

namespace sgs::gscore {

class GscoreDesign : public MachineDesign {
 public:
  void visit(ConfigVisitor& v) override { gscore::visit(v, config_); }
  StorageOrder storage_order() const override { return StorageOrder::kFile; }
  void resolve(const StorageConfig& storage, std::vector<AutoChoice>& chosen) override;
  void fit_memories() override { config_.sram.buffer_bytes = 0; }
  void adapt(const SecondHalfFormat& format, std::vector<AutoChoice>& chosen) override;
  FrameJob job(const StoredScene& scene, const Camera& camera) const override;
  GoldenFrame golden(const StoredScene& scene, const FrameJob& job,
                     DataSheet& sheet) const override;
  std::unique_ptr<Machine> build(const sc_core::sc_module_name& name, const FrameJob& job,
                                 const BuildOptions& options) const override;

 private:
  GscoreConfig config_;
};

// Tiles and working regions of a job that has passed as a FrameJob.
GscoreJob gscore_job(const GscoreConfig& config, const FrameJob& job);

// Adds the working regions of a frame behind the scene's. Throws InputError where the pool of lists
// cannot hold every Gaussian in one tile.
void add_regions(const GscoreConfig& config, FrameJob& job);

}  // namespace sgs::gscore
