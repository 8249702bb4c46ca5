// The design of the tile-centric machine.
#pragma once

#include "modules/gscore/gscore_config.h"
#include "modules/gscore/gscore_job.h"
#include "modules/machine_design.h"

namespace sgs::gscore {

class GscoreDesign : public MachineDesign {
 public:
  void visit(ConfigVisitor& v) override { gscore::visit(v, config_); }
  StorageOrder storage_order() const override { return config_.storage_order(); }
  void fit_frames(const std::function<std::vector<PixelSize>()>& frames) override;
  bool draw_two_eyes() override {
    config_.eyes = 2;
    return true;
  }
  void resolve(const StorageConfig& storage, std::vector<AutoChoice>& chosen) override;
  std::vector<const char*> fit_memories() override {
    memory_fitted_ = true;
    return {"sram.buffer_bytes"};
  }
  void adapt(const SecondHalfFormat& format, std::vector<AutoChoice>& chosen) override;
  FrameJob job(const StoredScene& scene, const Camera& camera) const override;
  GoldenFrame golden(const StoredScene& scene, const FrameJob& job,
                     DataSheet& sheet) const override;
  std::string golden_key() const override;
  PixelSize piece() const override { return square_of(kTilePx); }
  std::unique_ptr<Machine> build(const sc_core::sc_module_name& name, const FrameJob& job,
                                 const BuildOptions& options) const override;

 private:
  GscoreConfig config_;
  std::uint32_t tiles_ = 0;     // tiles of the largest frame; 0: not known
  bool memory_fitted_ = false;  // fit_memories()
};

}  // namespace sgs::gscore
