// The design of the toy machine, a third kind beside those of the factory.
#pragma once

#include "modules/machine_design.h"
#include "tests/testbench/toy_machine/toy_config.h"

namespace sgs::toy {

class ToyDesign : public MachineDesign {
 public:
  void visit(ConfigVisitor& v) override { toy::visit(v, config_); }
  StorageOrder storage_order() const override { return StorageOrder::kFile; }
  void resolve(const StorageConfig& storage, std::vector<AutoChoice>& chosen) override;
  void adapt(const SecondHalfFormat&, std::vector<AutoChoice>&) override {}
  FrameJob job(const StoredScene& scene, const Camera& camera) const override;
  GoldenFrame golden(const StoredScene& scene, const FrameJob& job,
                     DataSheet& sheet) const override;
  std::unique_ptr<Machine> build(const sc_core::sc_module_name& name, const FrameJob& job,
                                 const BuildOptions& options) const override;

 private:
  ToyConfig config_;
};

}  // namespace sgs::toy
