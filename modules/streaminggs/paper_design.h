// The design of the machine of paper order.
#pragma once

#include <optional>

#include "modules/machine_design.h"
#include "modules/streaminggs/paper_config.h"
#include "modules/streaminggs/streaming_sram.h"

namespace sgs {

class PaperDesign : public MachineDesign {
 public:
  void visit(ConfigVisitor& v) override { sgs::visit(v, config_); }
  StorageOrder storage_order() const override { return StorageOrder::kVoxels; }
  void resolve(const StorageConfig& storage, std::vector<AutoChoice>& chosen) override;
  void fit_frames(const std::function<std::vector<PixelSize>()>& frames) override {
    sram_.frames = frames_for(config_, frames);
  }
  std::vector<const char*> fit_memories() override { return sram_.fit(); }
  void adapt(const SecondHalfFormat& format, std::vector<AutoChoice>& chosen) override;
  FrameJob job(const StoredScene& scene, const Camera& camera) const override;
  GoldenFrame golden(const StoredScene& scene, const FrameJob& job,
                     DataSheet& sheet) const override;
  std::string golden_key() const override;
  std::optional<PaperOrderConfig> paper_order() const override;
  PixelSize group() const override { return config_.group(); }
  double stated_area_mm2() const override { return config_.stated_area_mm2; }
  std::unique_ptr<Machine> build(const sc_core::sc_module_name& name, const FrameJob& job,
                                 const BuildOptions& options) const override;

 private:
  void resolve_step_depths(const OperationLatencies& latencies, std::vector<AutoChoice>& chosen);
  void resolve_sampling_depths(const OperationLatencies& latencies,
                               std::vector<AutoChoice>& chosen);
  void publish_left_out(const StoredScene& scene, std::uint64_t voxels_met, DataSheet& sheet) const;

  PaperConfig config_;
  SramPlan sram_;
  StorageConfig storage_;  // storage of the scenes that it is built for
};

}  // namespace sgs
