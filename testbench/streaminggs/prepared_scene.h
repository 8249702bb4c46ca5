// A scene made ready for the accelerator: encoded and laid out for the configured order.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "algorithm/memory/image_file.h"
#include "algorithm/memory/stored_scene.h"
#include "algorithm/render/streaming_result.h"
#include "algorithm/scene/load_scene.h"
#include "modules/accelerator_config.h"
#include "modules/frame_job.h"

namespace sgs {

class PreparedScene {
 public:
  // weighing: cameras that weigh the Gaussians where second halves are quantised; progress of that
  // goes to stderr if it is a terminal.
  PreparedScene(Scene scene, const AcceleratorConfig& config, const std::vector<Camera>& weighing);

  // Of the file `path` made by pack; config has adopted it (packed_config.h).
  PreparedScene(PackedScene packed, const std::string& path, const AcceleratorConfig& config);

  const std::string& name() const { return name_; }
  std::uint64_t dropped_invalid() const { return dropped_invalid_; }
  std::uint64_t gaussians() const { return stored_.gaussians; }  // in the scene
  const MemoryImage& image() const { return stored_.image; }
  const StoredScene& stored() const { return stored_; }

  // What the units decode; the golden images are of this.
  const ActivatedCloud& decoded() const { return stored_.decoded; }
  // What it was encoded from; null where nothing was lost or the original is not at hand.
  const ActivatedCloud* original() const { return original_ ? &*original_ : nullptr; }

  // The registers of a frame. Throws InputError when scene and frame do not fit the memory.
  FrameJob job(const Camera& camera) const;

  // What the accelerator must render, by the streaming renderer of the same order.
  StreamingResult golden(const FrameJob& job) const;

 private:
  const AcceleratorConfig config_;
  std::string name_;
  std::uint64_t dropped_invalid_ = 0;
  std::optional<ActivatedCloud> original_;
  StoredScene stored_;
};

}  // namespace sgs
