// The float projection with a bound on its rounding.
#pragma once

#include <cstddef>

#include "algorithm/scene/camera.h"
#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/splat/projection.h"
#include "tests/algorithm/render/tracked.h"

namespace sgs::test {

// The view as float holds it, with what rounding took.
View<Tracked> tracked_view(const Camera& camera);

// Gaussian `i` after activation, in double, with what rounding to float takes.
Gaussian<Tracked> tracked_gaussian(const GaussianCloud& cloud, std::size_t i);

}  // namespace sgs::test
