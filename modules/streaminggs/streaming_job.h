// A frame's job as the units of a streaming machine know it: pixel groups, one after the other.
#pragma once

#include <vector>

#include "algorithm/splat/rects.h"
#include "modules/frame_job.h"

namespace sgs {

struct StreamingJob : FrameJob {
  std::vector<PixelRect> groups;  // in the order in which they are rendered
};

}  // namespace sgs
