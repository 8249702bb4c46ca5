// Seeded random Gaussians and views of every kind that makes rounding and bounds hard.
#pragma once

#include <glm/geometric.hpp>
#include <random>

#include "algorithm/scene/camera.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/splat/view.h"

namespace sgs::test {

class RandomGaussians {
 public:
  RandomGaussians(unsigned seed, int width_px, int height_px)
      : random_(seed), width_(width_px), height_(height_px) {}

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  double log_uniform(double low, double high) {
    return std::exp(uniform(std::log(low), std::log(high)));
  }
  double normal() { return std::normal_distribution<double>()(random_); }
  int pick(int choices) { return std::uniform_int_distribution<int>(0, choices - 1)(random_); }

  // A camera anywhere, near the origin or 10^4 units away, looking anywhere, of any focal length.
  Camera camera() {
    Camera camera;
    camera.width = width_;
    camera.height = height_;
    camera.focal_x = width_ * log_uniform(0.4, 3);
    camera.focal_y = camera.focal_x * uniform(0.8, 1.25);
    const double reach = pick(2) == 0 ? 1.0 : 1e4;
    camera.position = {reach * normal(), reach * normal(), reach * normal()};
    const glm::dvec3 z = glm::normalize(glm::dvec3(normal(), normal(), normal()));
    const glm::dvec3 x = glm::normalize(glm::cross(z, glm::dvec3(normal(), normal(), normal())));
    camera.world_from_camera = glm::dmat3(x, glm::cross(z, x), z);
    return camera;
  }

  // A Gaussian that mostly is near the frame: 0.01 px to 10^6 px wide, round, flat or needle with
  // axis ratios to 10^10, from the near plane on, opacity across (0, 1) and at both thresholds.
  Gaussian<float> gaussian(const Camera& camera) {
    const double depth = pick(4) == 0 ? uniform(0.1999, 0.2001) : log_uniform(0.2, 1000);
    const double width = camera.width, height = camera.height;
    const double sigma_px = pick(3) == 0 ? log_uniform(10, 1e6) : log_uniform(0.01, 50);
    const double stray = pick(3) == 0 ? 3 * sigma_px : 0;
    const double column = uniform(-0.2 * width, 1.2 * width) + stray * normal();
    const double row = uniform(-0.2 * height, 1.2 * height) + stray * normal();
    const glm::dvec3 v{(column - 0.5 * (width - 1)) / camera.focal_x * depth,
                       (row - 0.5 * (height - 1)) / camera.focal_y * depth, depth};
    Gaussian<float> g{};
    g.mean = glm::vec3(camera.world_from_camera * v + camera.position);
    const double widest = sigma_px * depth / camera.focal_x;
    const double ratio = pick(2) == 0 ? log_uniform(1, 10) : log_uniform(1, 1e10);
    for (int axis = 0; axis < 3; ++axis) {
      g.scale[axis] = static_cast<float>(widest / (pick(2) == 0 ? 1.0 : ratio));
    }
    double length = 0, q[4];
    for (double& component : q) {
      component = normal();
      length += component * component;
    }
    for (std::size_t k = 0; k < 4; ++k) g.quat[k] = static_cast<float>(q[k] / std::sqrt(length));
    const double opacities[] = {uniform(0, 1), 1.0, 0.99, 1.0 / 255, log_uniform(0.003, 0.006)};
    g.opacity = static_cast<float>(opacities[pick(5)]);
    return g;
  }

 private:
  std::mt19937 random_;
  int width_, height_;  // px
};

}  // namespace sgs::test
