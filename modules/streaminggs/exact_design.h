// The design of the machine of exact order.
#pragma once

#include "algorithm/render/exact_renderer.h"
#include "modules/machine_design.h"
#include "modules/streaminggs/exact_config.h"
#include "modules/streaminggs/streaming_sram.h"

namespace sgs {

class ExactDesign : public MachineDesign {
 public:
  void visit(ConfigVisitor& v) override { sgs::visit(v, config_); }
  StorageOrder storage_order() const override { return StorageOrder::kChunks; }
  bool draw_two_eyes() override {
    config_.hfu.eyes = 2;
    return true;
  }
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
  bool draws_reference() const override;
  PixelSize group() const override { return config_.group(); }
  std::unique_ptr<Machine> build(const sc_core::sc_module_name& name, const FrameJob& job,
                                 const BuildOptions& options) const override;

 private:
  ExactOrderConfig order() const;
  void publish_left_out(const StoredScene& scene, const StreamingStats& stats,
                        DataSheet& sheet) const;

  ExactConfig config_;
  SramPlan sram_;
  StorageConfig storage_;  // storage of the scenes that it is built for
};

}  // namespace sgs
