// Inputs of the tracked projection: doubles, each with its distance from the float in use.
#include "tests/algorithm/render/tracked_projection.h"

#include <cmath>

namespace sgs::test {

View<Tracked> tracked_view(const Camera& camera) {
  View<Tracked> view{};
  for (int k = 0; k < 3; ++k) {
    const auto high = static_cast<float>(camera.position[k]);
    view.position[k] = Tracked(high);
    view.position_low[k] = rounded(camera.position[k] - static_cast<double>(high));
    for (int row = 0; row < 3; ++row) {
      view.cam_from_world[row][k] = rounded(camera.world_from_camera[row][k]);
    }
  }
  view.focal_x = rounded(camera.focal_x);
  view.focal_y = rounded(camera.focal_y);
  const glm::dvec2 off = camera.principal_offset;
  view.limit_x = rounded((0.65 * camera.width + std::abs(off.x)) / camera.focal_x);
  view.limit_y = rounded((0.65 * camera.height + std::abs(off.y)) / camera.focal_y);
  view.centre_x = rounded(0.5 * (camera.width - 1) + off.x);
  view.centre_y = rounded(0.5 * (camera.height - 1) + off.y);
  view.width = camera.width;
  view.height = camera.height;
  return view;
}

Gaussian<Tracked> tracked_gaussian(const GaussianCloud& cloud, std::size_t i) {
  Gaussian<Tracked> g{};
  double length = 0;
  for (const float q : cloud.quats[i]) length += static_cast<double>(q) * q;
  for (int k = 0; k < 3; ++k) {
    g.mean[k] = Tracked(cloud.means[i][k]);
    g.scale[k] = rounded(std::exp(static_cast<double>(cloud.log_scales[i][k])));
  }
  for (std::size_t k = 0; k < 4; ++k) g.quat[k] = rounded(cloud.quats[i][k] / std::sqrt(length));
  return g;
}

}  // namespace sgs::test
