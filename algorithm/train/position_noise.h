// Random steps of Gaussians that are hardly there (Kheradmand et al. 2024, "3D Gaussian splatting
// as Markov chain Monte Carlo"): what lets them find where they are of use.
#pragma once

#include <cstdint>
#include <vector>

#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/splat/gaussian.h"

namespace sgs {

// mean += factor sigmoid(100 (0.005 - opacity)) Sigma xi, xi normal of the seed, the step and the
// Gaussian. factor: 1/world units. activated: activate(cloud). Gaussians of an opacity above 0.25
// would move by less than 2^-30 of that and stay. Returns those that were moved, ascending.
std::vector<std::uint32_t> add_position_noise(GaussianCloud& cloud, const ActivatedCloud& activated,
                                              double factor, std::uint64_t seed,
                                              std::uint64_t step);

}  // namespace sgs
