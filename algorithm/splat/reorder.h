// Clouds in another order.
#pragma once

#include <cstdint>
#include <vector>

#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/splat/gaussian.h"

namespace sgs {

// order: [place] index in `cloud` of what goes there; it may leave Gaussians out.
ActivatedCloud reordered(const ActivatedCloud& cloud, const std::vector<std::uint32_t>& order);
GaussianCloud reordered(const GaussianCloud& cloud, const std::vector<std::uint32_t>& order);

}  // namespace sgs
