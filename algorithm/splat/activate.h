// From the parameters of a file to those of the datapath (3D Gaussian Splatting, Kerbl et al.
// 2023).
#pragma once

#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/splat/gaussian.h"

namespace sgs {

// scale = exp(log_scale), opacity = 1 / (1 + exp(-logit)), quat / |quat|, each in double, rounded
// to float once. The reader has refused zero quaternions and values that are not finite.
ActivatedCloud activate(const GaussianCloud& cloud);

}  // namespace sgs
