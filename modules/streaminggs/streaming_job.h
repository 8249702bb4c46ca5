// A frame's job as the units of a streaming machine know it: pixel groups, one after the other.
#pragma once

#include <cstdint>
#include <vector>

#include "algorithm/splat/rects.h"
#include "modules/frame_job.h"

namespace sgs {

struct StreamingJob : FrameJob {
  std::vector<PixelRect> groups;  // in the order in which they are rendered, frame after frame
  // [part][group] what each of the HFUs that share a fetch has of a group; one part: all of it. Of
  // two eyes the parts of the left one's picture come first, then as many of the right one's.
  std::vector<std::vector<PixelRect>> parts;

  std::uint32_t parts_of_group() const { return static_cast<std::uint32_t>(parts.size()) / eyes; }
  std::uint32_t eye_of(std::uint32_t part) const { return part / parts_of_group(); }

  std::uint32_t groups_of_frame() const {
    return static_cast<std::uint32_t>(groups.size()) / frames();
  }
  std::uint32_t frame_of(std::uint32_t group) const { return group / groups_of_frame(); }
  bool begins_frame(std::uint32_t group) const { return group % groups_of_frame() == 0; }
  bool ends_frame(std::uint32_t group) const { return begins_frame(group + 1); }
  const Picture& picture_of(std::uint32_t group) const { return picture(frame_of(group)); }
  const View<float>& view_of(std::uint32_t group, std::uint32_t eye = 0) const {
    return picture(frame_of(group), eye).view;
  }
};

}  // namespace sgs
