// Noise.
#include "testbench/builtin/random.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>

namespace sgs {

namespace {

double lattice_value(std::int64_t x, std::int64_t y, std::int64_t z) {
  const auto cell = static_cast<std::uint64_t>(x) * 0x8da6b343u ^
                    static_cast<std::uint64_t>(y) * 0xd8163841u ^
                    static_cast<std::uint64_t>(z) * 0xcb1ab31fu;
  return static_cast<double>(mix_bits(cell) >> 11) * 0x1p-53;
}

}  // namespace

double value_noise(const glm::dvec3& point) {
  const glm::dvec3 base = glm::floor(point);
  const glm::dvec3 t = point - base;
  const glm::dvec3 weight = t * t * (3.0 - 2.0 * t);
  const auto x = static_cast<std::int64_t>(base.x), y = static_cast<std::int64_t>(base.y),
             z = static_cast<std::int64_t>(base.z);
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const int dx = corner & 1, dy = corner >> 1 & 1, dz = corner >> 2;
    sum += (dx ? weight.x : 1 - weight.x) * (dy ? weight.y : 1 - weight.y) *
           (dz ? weight.z : 1 - weight.z) * lattice_value(x + dx, y + dy, z + dz);
  }
  return sum;
}

double fractal_noise(const glm::dvec3& point, int octaves) {
  double sum = 0, weight = 0.5, total = 0;
  glm::dvec3 at = point;
  for (int octave = 0; octave < octaves; ++octave) {
    sum += weight * value_noise(at);
    total += weight;
    weight *= 0.5;
    at = at * 2.03 + 17.7;  // not exactly 2, so that the lattices do not line up
  }
  return sum / total;
}

double smooth_step(double low, double high, double value) {
  const double t = std::clamp((value - low) / (high - low), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

}  // namespace sgs
