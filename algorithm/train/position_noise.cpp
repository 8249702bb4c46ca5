#include "algorithm/train/position_noise.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>

#include "algorithm/train/counter_random.h"

namespace sgs {
namespace {

constexpr double kSteepness = 100, kMiddle = 0.005;
constexpr float kStaysAbove = 0.25F;

// Sigma xi = R S^2 R^T xi.
glm::dvec3 shaped(const Gaussian<float>& g, const glm::dvec3& xi) {
  const glm::dmat3 axes = glm::mat3_cast(glm::dquat(g.quat[0], g.quat[1], g.quat[2], g.quat[3]));
  const glm::dvec3 scale(g.scale);
  return axes * (scale * scale * (glm::transpose(axes) * xi));
}

}  // namespace

std::vector<std::uint32_t> add_position_noise(GaussianCloud& cloud, const ActivatedCloud& activated,
                                              double factor, std::uint64_t seed,
                                              std::uint64_t step) {
  std::vector<std::uint32_t> moved;
  for (std::size_t i = 0; i < activated.size(); ++i) {
    if (activated.gaussians[i].opacity <= kStaysAbove) {
      moved.push_back(static_cast<std::uint32_t>(i));
    }
  }
  const RandomUse use = RandomUse::kNoise;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, moved.size(), 256), [&](const auto& range) {
    for (std::size_t k = range.begin(); k != range.end(); ++k) {
      const std::uint32_t i = moved[k];
      const Gaussian<float>& g = activated.gaussians[i];
      CounterRandom random{seed, use, step, i};
      const double share = 1 / (1 + std::exp(kSteepness * (g.opacity - kMiddle)));
      cloud.means[i] += glm::vec3(factor * share * shaped(g, random.normal3()));
    }
  });
  return moved;
}

}  // namespace sgs
