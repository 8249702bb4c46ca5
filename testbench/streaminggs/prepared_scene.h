// A scene made ready for the accelerator: activated, and laid out for the configured order.
#pragma once

#include <cstdint>

#include "algorithm/memory/memory_image.h"
#include "algorithm/render/streaming_result.h"
#include "algorithm/scene/load_scene.h"
#include "modules/accelerator_config.h"
#include "modules/frame_job.h"

namespace sgs {

class PreparedScene {
 public:
  PreparedScene(Scene scene, const AcceleratorConfig& config);

  const Scene& scene() const { return scene_; }
  const ActivatedCloud& cloud() const { return cloud_; }

  // Throws InputError when scene and frame do not fit the memory.
  MemoryImage memory_image(std::uint64_t frame_bytes) const;

  // What the accelerator must render, by the streaming renderer of the same order.
  StreamingResult golden(const FrameJob& job) const;

 private:
  const AcceleratorConfig config_;
  Scene scene_;
  ActivatedCloud cloud_;
  VoxelGrid grid_;  // paper order
  ChunkTree tree_;  // exact order
};

// The registers of a frame; the layout is still to be filled in.
FrameJob make_job(const Camera& camera, const AcceleratorConfig& config);

}  // namespace sgs
