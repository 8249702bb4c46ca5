#include "algorithm/train/fitting.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "algorithm/train/counter_random.h"

namespace sgs {

std::size_t ViewOrder::at(int step, std::size_t count) {
  const int views = static_cast<int>(count);
  if (step / views != order_of_) {
    order_of_ = step / views;
    order_.resize(count);
    std::iota(order_.begin(), order_.end(), 0);
    CounterRandom random{seed_, RandomUse::kOrderOfViews, static_cast<std::uint64_t>(order_of_)};
    for (std::size_t i = count; i > 1; --i) std::swap(order_[i - 1], order_[random.below(i)]);
  }
  return order_[static_cast<std::size_t>(step % views)];
}

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
