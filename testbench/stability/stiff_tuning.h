// How far a tuning of a scene goes with stiff scenes and long steps: until it ends, or until it
// says at which step and Gaussian it stopped, and what is left then.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/train/tuning_config.h"

namespace sgs {

// What is tuned back to the pictures of the usual scene, and which rates are multiplied.
struct StiffCase {
  std::string scene, rates;
  std::function<void(GaussianCloud&)> make_stiff;
  std::function<void(LearningSchedule&, double factor)> lengthen;
};
std::vector<StiffCase> stiff_cases();

struct StiffRun {
  double factor;        // of the rates
  int steps;            // that were done
  std::string stopped;  // what was said, with step and Gaussian; empty: it went to its end
  double first_loss, last_loss;
  bool good;  // what is left is within the limits of scenes, is drawn in numbers and is restored
              // from what is saved
};

// `steps` steps with these rates, times `factor`, of a scene of few Gaussians and its own pictures.
StiffRun tuned(const StiffCase& of, double factor, int steps);

}  // namespace sgs
