// From the parameters of the datapath back to those of a file.
#pragma once

#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/splat/gaussian.h"

namespace sgs {

// log_scale = ln(scale), logit = ln(opacity / (1 - opacity)), each the nearest float. What
// activation makes of them is within a few units in the last place: not every scale, opacity and
// unit quaternion is one that floats of a file lead to. 0 and 1 come back as they are.
GaussianCloud deactivate(const ActivatedCloud& cloud);

// ln(scale), of 0 a number whose exponential is 0 as a float.
float log_scale_of(float scale);

}  // namespace sgs
