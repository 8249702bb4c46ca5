// Smooth noise for terrain, clouds and textures.
#pragma once

#include <glm/vec3.hpp>

namespace sgs {

// Value noise: 0 to 1, smooth, features of about one unit, the same everywhere for equal input.
double value_noise(const glm::dvec3& point);

// Sum of `octaves` of value noise, each of half the size and half the weight; 0 to 1.
double fractal_noise(const glm::dvec3& point, int octaves);

// 0 below `low`, 1 above `high`, smooth between.
double smooth_step(double low, double high, double value);

}  // namespace sgs
