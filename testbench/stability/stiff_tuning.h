// How far a tuning of a scene goes with stiff scenes and long steps: until it ends, or until it
// says at which step and Gaussian it stopped, and what is left then.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/train/fitting.h"

namespace sgs {

// A scene that is tuned back to the pictures of the usual one, and the rates that are multiplied.
struct StiffCase {
  std::string scene, rates;
  std::function<void(GaussianCloud&)> make_stiff;
  std::function<void(LearningSchedule&, double factor)> lengthen;
};
std::vector<StiffCase> stiff_cases();

struct StiffRun {
  double factor;        // multiplies the rates
  int steps;            // steps done
  std::string stopped;  // the message, with step and Gaussian; empty: it went to its end
  double first_loss, last_loss;
  bool good;  // the result is within the limits of scenes, drawn in numbers and restored from its
              // saved state
};

// `steps` steps with these rates, times `factor`, of a scene of few Gaussians and its own pictures.
StiffRun tuned(const StiffCase& of, double factor, int steps);

}  // namespace sgs
