// Colour by spherical harmonics with all its digits; the factors from their closed forms.
#pragma once

#include <vector>

#include "testbench/stability/exact.h"

namespace sgs {

// rgb of coefficients [(degree+1)^2] seen along `offset` (world, any length), before the clamp at
// 0.
ExactVector exact_colour(int degree, const std::vector<ExactVector>& coeffs,
                         const ExactVector& offset);

}  // namespace sgs
