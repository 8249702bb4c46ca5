// The registers that the host writes into an accelerator before a frame.
#pragma once

#include <glm/vec3.hpp>

#include "algorithm/memory/frame_buffer.h"
#include "algorithm/memory/scene_layout.h"
#include "algorithm/splat/view.h"

namespace sgs {

struct FrameJob {
  View<float> view{};
  glm::vec3 background{0.0F};
  SceneLayout layout;  // the scene's regions, then those that the machine uses
  FrameFormat frame_format = FrameFormat::kRgb8;
  RegionSpan spill;         // for data that the machine puts aside during the frame; may be empty
  RegionSpan frame_buffer;  // rows from the top, pixels without padding

  std::uint64_t pixel_address(int x, int y) const {
    return frame_buffer.base +
           (static_cast<std::uint64_t>(y) * view.width + x) * pixel_bytes(frame_format);
  }
};

}  // namespace sgs
