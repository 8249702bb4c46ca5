// One Gaussian as the datapath computes with it: activations applied, quaternion normalised.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

namespace sgs {

template <class T>
struct Gaussian {
  glm::vec<3, T> mean;    // world
  glm::vec<3, T> scale;   // standard deviation along each axis, world units
  std::array<T, 4> quat;  // (w, x, y, z), unit length
  T opacity;              // (0, 1)
};

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

}  // namespace sgs
