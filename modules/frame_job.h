// What the host writes into an accelerator's registers before a frame.
#pragma once

#include <glm/vec3.hpp>

#include "algorithm/memory/frame_buffer.h"
#include "algorithm/memory/scene_layout.h"
#include "algorithm/splat/view.h"

namespace sgs {

struct FrameJob {
  View<float> view{};
  glm::vec3 background{0.0F};
  SceneLayout
      layout;  // its regions: the scene's, and behind them those that the machine works with
  FrameFormat frame_format = FrameFormat::kRgb8;
  RegionSpan spill;         // what the machine puts aside during the frame; may be empty
  RegionSpan frame_buffer;  // rows from the top, pixels without padding

  std::uint64_t pixel_address(int x, int y) const {
    return frame_buffer.base +
           (static_cast<std::uint64_t>(y) * view.width + x) * pixel_bytes(frame_format);
  }
};

}  // namespace sgs
