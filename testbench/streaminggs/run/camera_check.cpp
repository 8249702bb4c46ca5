// Centres in a frame.
#include "testbench/streaminggs/run/camera_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace sgs {

double share_in_frame(const ActivatedCloud& cloud, const Camera& camera) {
  const glm::dmat3 camera_from_world = glm::transpose(camera.world_from_camera);
  const glm::dvec2 focal(camera.focal_x, camera.focal_y);
  const glm::dvec2 half = glm::dvec2(camera.width, camera.height) / 2.0;
  const glm::dvec2 off = camera.principal_offset;
  const auto seen = [&](const Gaussian<float>& gaussian) {
    const glm::dvec3 v = camera_from_world * (glm::dvec3(gaussian.mean) - camera.position);
    return v.z > 0 && std::abs(focal.x * v.x + off.x * v.z) <= half.x * v.z &&
           std::abs(focal.y * v.y + off.y * v.z) <= half.y * v.z;
  };
  const auto count = std::count_if(cloud.gaussians.begin(), cloud.gaussians.end(), seen);
  return static_cast<double>(count) / static_cast<double>(cloud.size());
}

std::string doubt_about(const Camera& camera, const ActivatedCloud& cloud) {
  if (cloud.size() == 0) return "";
  const double share = share_in_frame(cloud, camera);
  if (share >= kLeastShareInFrame) return "";
  std::string text = fmt::format(
      "{:.2f} % of the Gaussians lie in the frame: is this a camera of this scene?", 100 * share);
  if (!camera.axes.empty()) {
    text += fmt::format(" Expected poses {}, in the scene's coordinates", camera.axes);
  }
  return text + "; --scene-axes turns a scene";
}

}  // namespace sgs
