// Where two pictures differ, and by how much, as a picture with a legend.
#pragma once

#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "algorithm/image/image.h"

namespace sgs {

// Errors below count as none: rounding to 8 bits leaves up to 1/510 = 0.00196.
constexpr double kLeastShownError = 0.002;

// The colour of an error: black below kLeastShownError; from there, by its logarithm, from dark
// blue over red to bright yellow at 1, in steps that look alike. Infinity is bright yellow.
glm::vec3 error_colour(double error);

// The largest channel error of each pixel as error_colour, both pictures clamped to [0, 1] as the
// eye sees them; a NaN on one side only is infinite. To the right of it a legend: the lines of
// `caption`, the largest error of the picture, and the scale, which is the same for all pictures.
// The result is wider than the pictures, and higher where they are too low for the legend. Throws
// InputError when they differ in size or have no pixels.
Image error_map(const Image& a, const Image& b, const std::vector<std::string>& caption);

}  // namespace sgs
