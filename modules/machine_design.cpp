// What designs of all machines do alike.
#include "modules/machine_design.h"

#include <fmt/format.h>

#include "algorithm/files/input_error.h"
#include "algorithm/memory/frame_buffer.h"

namespace sgs {

FrameJob MachineDesign::stream(const StoredScene& scene, const std::vector<Camera>& cameras) const {
  FrameJob job = this->job(scene, cameras.front());
  std::vector<Picture> pictures[2];  // [frame modulo 2][eye]
  for (std::uint32_t eye = 0; eye < job.eyes; ++eye) {
    pictures[0].push_back(job.picture(0, eye));
    pictures[1].push_back(job.picture(0, eye));
    pictures[1].back().frame_buffer = job.layout.regions.add(
        eye == 0 ? "second_frame_buffer" : "second_right_frame_buffer", job.frame_buffer.bytes);
  }
  for (std::size_t frame = 1; frame < cameras.size(); ++frame) {
    for (std::uint32_t eye = 0; eye < job.eyes; ++eye) {
      Picture picture = pictures[frame % 2][eye];
      picture.view = make_view<float>(cameras[frame]);
      if (eye > 0) picture.view = right_eye(picture.view);
      job.following.push_back(picture);
    }
  }
  return job;
}

void check_eyes(std::uint32_t eyes, const Camera& camera) {
  if ((eyes > 1) == (camera.eyes_apart != 0)) return;
  throw InputError(
      fmt::format("eyes: got {}, expected {}: --stereo draws pairs of pictures, and sets it", eyes,
                  eyes > 1 ? 1 : 2));
}

void add_frame_buffers(FrameJob& job) {
  const std::uint64_t bytes =
      std::uint64_t{pixel_bytes(job.frame_format)} * job.view.width * job.view.height;
  job.frame_buffer = job.layout.regions.add("frame_buffer", bytes);
  if (job.view.eyes < 2) return;
  job.eyes = 2;
  Picture right = job;
  right.view = right_eye(job.view);
  right.frame_buffer = job.layout.regions.add("right_frame_buffer", bytes);
  job.following = {right};
}

}  // namespace sgs
