// One Gaussian as the datapath computes with it: activations applied, quaternion normalised; and
// clouds of them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "algorithm/splat/scalar.h"

namespace sgs {

struct GaussianCloud;

template <class T>
struct Gaussian {
  glm::vec<3, T> mean;    // world
  glm::vec<3, T> scale;   // standard deviation along each axis, world units
  std::array<T, 4> quat;  // (w, x, y, z), unit length
  T opacity;              // (0, 1)
};

// The component of a unit quaternion that follows from the other three, where these are smaller:
// not negative. In this order of operations, each rounded to T.
template <class T>
T largest_component(const std::array<T, 3>& others) {
  T squared = T(1.0F);
  for (const T& other : others) squared = T(squared - T(other * other));
  return sqrt_of(max_of(T(0.0F), squared));
}

// x and so many units in its last place: an addition to its bits.
inline float moved_by_units(float x, int units) {
  return __builtin_bit_cast(float, __builtin_bit_cast(std::int32_t, x) + units);
}

// A GaussianCloud after activation: scale = exp, opacity = sigmoid, quaternion normalised.
// Computed in double and rounded once, so that memory image and renderers hold the same floats.
struct ActivatedCloud {
  int sh_degree = 0;
  std::vector<Gaussian<float>> gaussians;  // [N]
  std::vector<glm::vec3> sh_coeffs;        // [N, (degree+1)^2] rgb

  std::size_t size() const { return gaussians.size(); }
  const glm::vec3* sh(std::size_t index) const {
    const auto stride = static_cast<std::size_t>((sh_degree + 1) * (sh_degree + 1));
    return sh_coeffs.data() + index * stride;
  }
};

// A cloud in another order: [place] index in `cloud` of what goes there. It may leave Gaussians
// out.
ActivatedCloud reordered(const ActivatedCloud& cloud, const std::vector<std::uint32_t>& order);
GaussianCloud reordered(const GaussianCloud& cloud, const std::vector<std::uint32_t>& order);

}  // namespace sgs
