// What designs of all machines do alike.
#include "modules/machine_design.h"

namespace sgs {

FrameJob MachineDesign::stream(const StoredScene& scene, const std::vector<Camera>& cameras) const {
  FrameJob job = this->job(scene, cameras.front());
  const RegionSpan second = job.layout.regions.add("second_frame_buffer", job.frame_buffer.bytes);
  for (std::size_t frame = 1; frame < cameras.size(); ++frame) {
    Picture picture = job;
    picture.view = make_view<float>(cameras[frame]);
    if (frame % 2 == 1) picture.frame_buffer = second;
    job.following.push_back(picture);
  }
  return job;
}

}  // namespace sgs
