// How far a step goes for each kind of parameter, as in the original.
#pragma once

#include <vector>

#include "algorithm/scene/camera.h"

namespace sgs {

// Of one step, in units of the parameter.
struct LearningRates {
  double mean, log_scale, quat, opacity_logit;
  double sh_dc, sh_rest;
};

struct LearningSchedule {
  // Of means, as parts of the scene's extent: exponential from the first to the last step, then
  // constant.
  double mean_first = 1.6e-4, mean_last = 1.6e-6;
  int mean_steps = 30'000;
  double log_scale = 5e-3, quat = 1e-3;
  double opacity_logit = 0.05;  // 0.025 in later releases of the original
  double sh_dc = 2.5e-3, sh_rest = 1.25e-4;

  // step: from 0. extent: of the scene, world units.
  LearningRates at(int step, double extent) const;
};

// 1.1 times the largest distance of a camera from the mean of their positions, world units.
double scene_extent(const std::vector<Camera>& cameras);

}  // namespace sgs
