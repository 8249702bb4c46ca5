// What the toy machine needs, must give, and is built from.
#include "tests/testbench/toy_machine/toy_design.h"

#include <fmt/format.h>

#include <algorithm>

#include "algorithm/files/input_error.h"
#include "tests/testbench/toy_machine/toy_machine.h"
#include "tests/testbench/toy_machine/toy_picture.h"

namespace sgs::toy {

void ToyDesign::resolve(const StorageConfig&, std::vector<AutoChoice>& chosen) {
  if (config_.fetch.block_gaussians % 2 != 0) {
    throw InputError(fmt::format("fetch.block_gaussians: got {}, expected whole bursts of 32 B",
                                 config_.fetch.block_gaussians));
  }
  chosen.push_back({ChoiceKind::kDerived, "toy.blocks",
                    static_cast<double>(config_.fetch.buffer_blocks),
                    "as many as the configuration says"});
}

FrameJob ToyDesign::job(const StoredScene& scene, const Camera& camera) const {
  FrameJob job;
  job.view = make_view<float>(camera);
  job.layout = scene.image.layout;
  job.frame_format = config_.framebuffer;
  job.frame_buffer =
      job.layout.regions.add("frame_buffer", std::uint64_t{pixel_bytes(config_.framebuffer)} *
                                                 camera.width * camera.height);
  return job;
}

GoldenFrame ToyDesign::golden(const StoredScene& scene, const FrameJob& job,
                              DataSheet& sheet) const {
  const std::uint64_t stored = scene.image.layout.gaussian_count();
  sheet.left_out("second_halves", "a colour is made of centres", stored,
                 "everything but 16 B of each Gaussian");
  GoldenFrame golden;
  golden.image = picture_of(scene.image.bytes, job, config_);
  const auto groups = static_cast<std::uint32_t>(groups_of(job, config_).size());
  for (std::uint32_t group = 0; group < groups; ++group) {
    golden.contributing += block_of(group, job, config_).count;
  }
  golden.contributing = std::min(golden.contributing, stored);
  return golden;
}

std::unique_ptr<Machine> ToyDesign::build(const sc_core::sc_module_name& name, const FrameJob& job,
                                          const BuildOptions& options) const {
  return std::make_unique<ToyMachine>(name, config_, job, options);
}

}  // namespace sgs::toy
