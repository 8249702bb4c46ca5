// Making of hard scenes.
#include "tests/algorithm/voxel/hard_scenes.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "algorithm/scene/gaussian_cloud.h"

namespace sgs::test {

Camera HardScenes::camera(int longest_px) {
  Camera camera;
  camera.width = 1 + pick(longest_px);
  camera.height = 1 + pick(longest_px);
  camera.focal_x = camera.width * log_uniform(0.1, 10);
  camera.focal_y = camera.focal_x * uniform(0.8, 1.25);
  constexpr double kFarOut[] = {0, 1, 1e4, 1e6};
  camera.position = kFarOut[pick(4)] * normal3();
  if (pick(3) == 0) return camera;  // axis-parallel: depths are coordinates
  const glm::dvec3 z = glm::normalize(normal3());
  const glm::dvec3 x = glm::normalize(glm::cross(z, normal3()));
  camera.world_from_camera = glm::dmat3(x, glm::cross(z, x), z);
  return camera;
}

HardScenes::Cluster HardScenes::cluster(const Camera& camera) {
  Cluster c{};
  const double depths[] = {log_uniform(0.2, 10), log_uniform(0.2, 1e5), uniform(0.19, 0.22),
                           uniform(-2, 2)};
  const double depth = depths[pick(4)];
  const double beyond = pick(4) == 0 ? 3 : 0.6;  // of half a frame
  c.centre = {uniform(-beyond, beyond) * camera.width / camera.focal_x * depth,
              uniform(-beyond, beyond) * camera.height / camera.focal_y * depth, depth};
  const double pixel = std::max(0.2, std::abs(depth)) / camera.focal_x;  // world units
  const double sizes[] = {log_uniform(0.1, 30), log_uniform(0.1, 30), log_uniform(1e-6, 0.1),
                          log_uniform(30, 1e7)};
  c.scale = pixel * sizes[pick(4)];
  const double ratios[] = {1, 10, 1e10};
  c.ratio = ratios[pick(3)];
  const double spreads[] = {pixel * log_uniform(0.1, 1000), 1e-3, std::abs(depth)};
  c.spread = spreads[pick(3)];
  c.arrangement = pick(5);
  return c;
}

glm::dvec3 HardScenes::centre_in(const Cluster& c) {
  switch (c.arrangement) {
    case 0:  // all at one point
      return c.centre;
    case 1:  // in one plane of depth
      return c.centre + c.spread * glm::dvec3(normal(), normal(), 0);
    case 2:  // in a row away from the camera
      return c.centre * (1 + std::abs(normal()));
    default:
      return c.centre + c.spread * normal3();
  }
}

double HardScenes::opacity_logit() {
  const auto logit = [](double p) { return std::log(p) - std::log1p(-p); };
  const double choices[] = {logit(uniform(0.01, 0.99)), logit(uniform(0.01, 0.99)),
                            logit(1.0 / 255), logit(log_uniform(0.003, 0.006)), 200.0};
  return choices[pick(5)];
}

HardScene HardScenes::next(std::size_t gaussians, int longest_px) {
  HardScene scene;
  scene.camera = camera(longest_px);
  scene.cloud.resize(gaussians, pick(4));
  Cluster current = cluster(scene.camera);
  for (std::size_t i = 0; i < gaussians; ++i) {
    if (pick(12) == 0) current = cluster(scene.camera);
    const glm::dvec3 v = centre_in(current);
    scene.cloud.means[i] = glm::vec3(scene.camera.world_from_camera * v + scene.camera.position);
    const double scale = std::min(kMaxScale, current.scale * log_uniform(0.3, 3));
    for (int axis = 0; axis < 3; ++axis) {
      const double thinner = pick(2) == 0 ? 1 : log_uniform(1, current.ratio);
      scene.cloud.log_scales[i][axis] = static_cast<float>(std::log(scale / thinner));
    }
    const double length = log_uniform(1e-3, 1e3);
    for (float& component : scene.cloud.quats[i]) {
      component = static_cast<float>(length * normal());
    }
    if (pick(4) == 0) scene.cloud.quats[i] = {1, 0, 0, 0};
    scene.cloud.opacity_logits[i] = static_cast<float>(opacity_logit());
  }
  for (auto& coeff : scene.cloud.sh_coeffs) coeff = 0.4F * glm::vec3(normal3());
  return scene;
}

}  // namespace sgs::test
