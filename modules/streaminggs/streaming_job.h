// A frame's job as the units of a streaming machine know it: pixel groups, one after the other.
#pragma once

#include <vector>

#include "algorithm/splat/rects.h"
#include "modules/frame_job.h"

namespace sgs {

struct StreamingJob : FrameJob {
  std::vector<PixelRect> groups;  // in the order in which they are rendered
  // [part][group] what each of the HFUs that share a fetch has of a group; one part: all of it.
  std::vector<std::vector<PixelRect>> parts;
};

}  // namespace sgs
