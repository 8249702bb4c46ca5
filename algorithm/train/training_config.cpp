#include "algorithm/train/training_config.h"

#include <algorithm>
#include <cmath>

namespace sgs {

LearningRates TrainingConfig::rates_at(int step, double extent) const {
  LearningSchedule schedule = rates;
  schedule.mean_steps = steps;
  return schedule.at(step, extent);
}

int TrainingConfig::degree_at(int step) const {
  const double each = std::max(1.0, degrees_by * steps / std::max(1, sh_degree));
  return std::min(sh_degree, static_cast<int>(step / each));
}

double TrainingConfig::downscale_at(int step) const {
  const double until = full_size_from * steps;
  if (step >= until) return 1;
  const double first = 1 / (first_downscale * first_downscale);
  const double share = first + (1 - first) * step / until;
  // At least as many pixels as that.
  const double halvings = std::floor(std::log2(1 / share) + 1e-9);
  return std::exp2(halvings / 2);
}

bool TrainingConfig::grows_at(int step) const {
  return step >= grow_from * steps && step <= grow_to * steps && step % grow_every == 0;
}

}  // namespace sgs
