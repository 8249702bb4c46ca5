// What the comparisons of quality.h share.
#pragma once

#include <algorithm>
#include <glm/vec3.hpp>

#include "algorithm/image/image.h"

namespace sgs {

// Throws InputError unless both pictures have the same width and height and at least one pixel.
void check_same_size(const Image& a, const Image& b);

// Value limited to [0, 1]; NaN stays NaN.
inline float clamp_to_unit(float value) { return std::clamp(value, 0.0f, 1.0f); }
inline glm::vec3 clamp_to_unit(const glm::vec3& pixel) {
  return {clamp_to_unit(pixel.x), clamp_to_unit(pixel.y), clamp_to_unit(pixel.z)};
}

// Largest |a - b| of a channel. Equal infinities and two NaN agree; a NaN on one side only is an
// infinite error, so that it cannot hide.
double pixel_error(const glm::vec3& a, const glm::vec3& b);

}  // namespace sgs
