// Random numbers, even point sets and smooth noise that are the same with every compiler and
// library.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "algorithm/train/counter_random.h"

namespace sgs {

// A stream of numbers for each seed. The distributions of <random> differ between libraries; these
// do not, and a stream per Gaussian makes scenes independent of the number of threads.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(mix_bits(seed)) {}

  std::uint64_t bits() { return mix_bits(state_++); }

  // In [0, 1).
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }

  // Mean 0, deviation 1 (Box and Muller).
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(2.0 * M_PI * uniform());
  }

  // Evenly over the unit sphere.
  glm::dvec3 direction() {
    const double z = uniform(-1.0, 1.0), angle = uniform(0.0, 2.0 * M_PI);
    const double radius = std::sqrt(1.0 - z * z);
    return {radius * std::cos(angle), radius * std::sin(angle), z};
  }

 private:
  std::uint64_t state_;
};

// Point `index` of the R2 sequence (Roberts 2018) in the unit square: any first N points cover it
// evenly, each a cell of area 1/N.
inline glm::dvec2 even_point(std::uint64_t index) {
  constexpr double kStepX = 0.7548776662466927, kStepY = 0.5698402909980532;
  const double x = 0.5 + kStepX * static_cast<double>(index);
  const double y = 0.5 + kStepY * static_cast<double>(index);
  return {x - std::floor(x), y - std::floor(y)};
}

// Value noise: 0 to 1, smooth, features of about one unit, the same everywhere for equal input.
double value_noise(const glm::dvec3& point);

// Sum of `octaves` of value noise, each of half the size and half the weight; 0 to 1.
double fractal_noise(const glm::dvec3& point, int octaves);

// 0 below `low`, 1 above `high`, smooth between.
double smooth_step(double low, double high, double value);

}  // namespace sgs
