// Clouds of files as the scenes of the pixel loop, and back.
#pragma once

#include <cmath>

#include "algorithm/tune/scene_gradient.h"
#include "tests/algorithm/tune/pixel_loop.h"

namespace sgs::test {

inline SceneOf<float> scene_of(const GaussianCloud& cloud) {
  SceneOf<float> out;
  out.sh_degree = cloud.sh_degree;
  for (std::size_t i = 0; i < cloud.size(); ++i) out.raw.push_back(raw_gaussian(cloud, i));
  out.sh = cloud.sh_coeffs;
  return out;
}

inline GaussianCloud cloud_of(const SceneOf<float>& scene) {
  GaussianCloud out;
  out.resize(scene.raw.size(), scene.sh_degree);
  for (std::size_t i = 0; i < scene.raw.size(); ++i) {
    out.means[i] = scene.raw[i].mean;
    out.log_scales[i] = scene.raw[i].log_scale;
    out.quats[i] = scene.raw[i].quat;
    out.opacity_logits[i] = scene.raw[i].opacity_logit;
  }
  out.sh_coeffs = scene.sh;
  return out;
}

// With zeros for what is not seen.
inline SceneOf<float> dense(const CloudGradient& gradient, std::size_t count) {
  GaussianCloud out;
  out.resize(count, gradient.parameters.sh_degree);
  const auto coeffs = static_cast<std::size_t>(sh_coeff_count(out.sh_degree));
  for (std::size_t r = 0; r < gradient.size(); ++r) {
    const std::size_t i = gradient.indices[r];
    out.means[i] = gradient.parameters.means[r];
    out.log_scales[i] = gradient.parameters.log_scales[r];
    out.quats[i] = gradient.parameters.quats[r];
    out.opacity_logits[i] = gradient.parameters.opacity_logits[r];
    for (std::size_t c = 0; c < coeffs; ++c) {
      out.sh_coeffs[i * coeffs + c] = gradient.parameters.sh_coeffs[r * coeffs + c];
    }
  }
  return scene_of(out);
}

inline PixelGradient in_float(const LinearLoss& loss, const Camera& camera) {
  PixelGradient out;
  out.colour = Image(camera.width, camera.height);
  for (std::size_t i = 0; i < loss.colour.size(); ++i) {
    out.colour.pixels[i] = glm::vec3(loss.colour[i]);
    out.transmittance.push_back(static_cast<float>(loss.transmittance[i]));
  }
  return out;
}

// Summed squares of the exact gradients and of what ours are off by, of each kind of parameter: the
// first eleven of a Gaussian one by one, then all colour.
struct Deviation {
  double error[12] = {}, size[12] = {};

  double relative(int kind) const {
    return std::sqrt(error[kind]) / std::max(std::sqrt(size[kind]), 1e-8);
  }
};

inline Deviation deviation(const SceneOf<float>& ours_in_float, const SceneOf<double>& exact) {
  const auto ours = converted<double>(ours_in_float);
  Deviation out;
  for (std::size_t i = 0; i < exact.raw.size(); ++i) {
    std::size_t p = 0;
    for_parameters(
        i,
        [&](double a, double b) {
          const std::size_t kind = std::min<std::size_t>(p++, 11);
          out.error[kind] += (a - b) * (a - b);
          out.size[kind] += b * b;
        },
        ours, exact);
  }
  return out;
}

}  // namespace sgs::test
