// Schedules of learning rates.
#include "algorithm/tune/learning_rates.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace sgs {

LearningRates LearningSchedule::at(int step, double extent) const {
  const double done = std::clamp(static_cast<double>(step) / mean_steps, 0.0, 1.0);
  const double mean = std::exp(std::log(mean_first) * (1 - done) + std::log(mean_last) * done);
  return {mean * extent, log_scale, quat, opacity_logit, sh_dc, sh_rest};
}

double scene_extent(const std::vector<Camera>& cameras) {
  glm::dvec3 sum(0.0);
  for (const Camera& camera : cameras) sum += camera.position;
  const glm::dvec3 mean = sum / static_cast<double>(cameras.size());
  double farthest = 0;
  for (const Camera& camera : cameras) {
    farthest = std::max(farthest, glm::distance(camera.position, mean));
  }
  return 1.1 * farthest;
}

}  // namespace sgs
