// Where the order of a cloud's Gaussians shows: among those of equal depth.
#pragma once

#include <cstdint>
#include <vector>

#include "algorithm/splat/gaussian.h"
#include "algorithm/splat/view.h"

namespace sgs {

// Whether two Gaussians that may be seen have the same depth and `ranks` (of each Gaussian, all
// different) would order them otherwise than their indices do. Where none have, the reference
// picture of the cloud in the order of `ranks` is that of the cloud as it is, bit for bit.
bool reorders_ties(const View<float>& view, const ActivatedCloud& cloud,
                   const std::vector<std::uint32_t>& ranks);

}  // namespace sgs
