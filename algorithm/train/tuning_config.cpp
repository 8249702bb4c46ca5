#include "algorithm/train/tuning_config.h"

#include <algorithm>
#include <cmath>

namespace sgs {

LearningRates TuningConfig::rates_at(int step) const {
  const double done = static_cast<double>(step) / std::max(1, steps - 1);
  const double factor = rate * std::pow(last_rate, done);
  LearningRates out = rates.at(step, 0);
  for (double* each : {&out.log_scale, &out.quat, &out.opacity_logit, &out.sh_dc, &out.sh_rest}) {
    *each *= factor;
  }
  return out;
}

}  // namespace sgs
