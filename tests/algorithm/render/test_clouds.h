// Small clouds and cameras for tests of the renderers.
#pragma once

#include <cmath>
#include <random>

#include "algorithm/scene/camera.h"
#include "algorithm/scene/gaussian_cloud.h"

namespace sgs::test {

// At the origin, along +z.
inline Camera forward_camera(int width_px, int height_px, double focal_px) {
  Camera camera;
  camera.width = width_px;
  camera.height = height_px;
  camera.focal_x = camera.focal_y = focal_px;
  return camera;
}

// One Gaussian of degree 0 with colour rgb, round.
inline void add_ball(GaussianCloud& cloud, glm::vec3 mean, double radius, double opacity,
                     glm::vec3 rgb) {
  constexpr float kDc = 0.28209479177387814F;
  cloud.means.push_back(mean);
  cloud.log_scales.push_back(glm::vec3(static_cast<float>(std::log(radius))));
  cloud.quats.push_back({1, 0, 0, 0});
  cloud.opacity_logits.push_back(static_cast<float>(std::log(opacity) - std::log1p(-opacity)));
  cloud.sh_coeffs.push_back((rgb - 0.5F) / kDc);
}

// `count` Gaussians in a ball of radius `extent` around `centre`, scales log-uniform between the
// two given, axis ratios to 30, quaternions of any length, all opacities.
inline GaussianCloud random_cloud(unsigned seed, std::size_t count, int degree, glm::vec3 centre,
                                  float extent, float smallest, float largest) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<float> uniform;
  GaussianCloud cloud;
  cloud.resize(count, degree);
  for (std::size_t i = 0; i < count; ++i) {
    const float scale = std::log(smallest) + uniform(random) * std::log(largest / smallest);
    for (int k = 0; k < 3; ++k) {
      cloud.means[i][k] = centre[k] + extent * 0.5F * normal(random);
      cloud.log_scales[i][k] = scale - 3.4F * uniform(random);
    }
    const float length = std::exp(2 * normal(random));
    for (float& component : cloud.quats[i]) component = length * normal(random);
    cloud.opacity_logits[i] = 3 * normal(random);
  }
  for (auto& coeff : cloud.sh_coeffs) {
    coeff = 0.4F * glm::vec3(normal(random), normal(random), normal(random));
  }
  return cloud;
}

}  // namespace sgs::test
