// What the host writes into the accelerator's registers before a frame.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "algorithm/memory/memory_image.h"
#include "algorithm/splat/rects.h"
#include "algorithm/splat/view.h"

namespace sgs {

struct FrameJob {
  View<float> view{};
  glm::vec3 background{0.0F};
  MemoryLayout layout;
  FrameFormat frame_format = FrameFormat::kRgb8;
  int group_px = 64;
  std::vector<PixelRect> groups;  // in the order in which they are rendered
};

}  // namespace sgs
