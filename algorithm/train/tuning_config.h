// How a scene that stands is tuned: what both tunings have in common.
#pragma once

#include <cstdint>

#include "algorithm/train/comparison.h"
#include "algorithm/tune/learning_rates.h"

namespace sgs {

struct TuningConfig {
  int steps = 3'000;
  std::uint64_t seed = 1;  // of the order of views
  ComparisonRule comparison;
  // Rates are the original's, centres rest; times `rate` at first and `last_rate` of that in the
  // end, falling exponentially.
  LearningSchedule rates;
  double rate = 1, last_rate = 0.1;

  // step: from 0.
  LearningRates rates_at(int step) const;
};

}  // namespace sgs
