// What the comparisons of quality.h share.
#pragma once

#include <algorithm>

#include "algorithm/image/image.h"

namespace sgs {

// Throws InputError unless both pictures have the same width and height and at least one pixel.
void check_same_size(const Image& a, const Image& b);

// Value limited to [0, 1]; NaN stays NaN.
inline float clamp_to_unit(float value) { return std::clamp(value, 0.0f, 1.0f); }

}  // namespace sgs
