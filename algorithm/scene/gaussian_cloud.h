// A trained 3D Gaussian scene with the parameters as the file holds them, before any activation.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

namespace sgs {

// Spherical-harmonics coefficients per colour channel: 1, 4, 9, 16 for degrees 0 to 3.
constexpr int sh_coeff_count(int degree) { return (degree + 1) * (degree + 1); }

struct GaussianCloud {
  int sh_degree = 0;                        // 0 to 3
  std::vector<glm::vec3> means;             // [N] centre, world frame
  std::vector<glm::vec3> log_scales;        // [N] scale = exp(log_scale), world units
  std::vector<std::array<float, 4>> quats;  // [N] (w, x, y, z), any length but zero
  std::vector<float> opacity_logits;        // [N] opacity = sigmoid(logit)
  std::vector<glm::vec3> sh_coeffs;         // [N, (degree+1)^2] rgb; entry 0 is f_dc

  std::size_t size() const { return means.size(); }
  void resize(std::size_t count, int degree) {
    sh_degree = degree;
    means.resize(count);
    log_scales.resize(count);
    quats.resize(count);
    opacity_logits.resize(count);
    sh_coeffs.resize(count * static_cast<std::size_t>(sh_coeff_count(degree)));
  }
};

}  // namespace sgs
