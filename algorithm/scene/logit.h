// Opacities as files and training keep them.
#pragma once

#include <cmath>

namespace sgs {

// ln(p / (1 - p)) of p in [0, 1]; -inf and inf at its ends.
inline double logit(double p) { return std::log(p / (1 - p)); }

// Its inverse.
inline double sigmoid(double logit) { return 1 / (1 + std::exp(-logit)); }

}  // namespace sgs
