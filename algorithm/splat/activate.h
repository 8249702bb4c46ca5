// From the parameters of a file to those of the datapath and back (3D Gaussian Splatting, Kerbl et
// al. 2023).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/splat/scalar.h"

namespace sgs {

// The parameters of one Gaussian that activation acts on, as the file holds them.
template <class T>
struct RawGaussian {
  glm::vec<3, T> mean;       // world
  glm::vec<3, T> log_scale;  // scale = exp(log_scale), world units
  std::array<T, 4> quat;     // (w, x, y, z), any length but zero
  T opacity_logit;           // opacity = sigmoid(logit)
};

inline RawGaussian<float> raw_gaussian(const GaussianCloud& cloud, std::size_t index) {
  return {cloud.means[index], cloud.log_scales[index], cloud.quats[index],
          cloud.opacity_logits[index]};
}

// The scalar that activations of T are computed in: float's in double, rounded once.
template <class T>
struct ActivationScalar {
  using type = T;
};
template <>
struct ActivationScalar<float> {
  using type = double;
};

// scale = exp(log_scale), opacity = 1 / (1 + exp(-logit)), quat / |quat|.
template <class T>
Gaussian<T> activate(const RawGaussian<T>& raw) {
  using Wide = typename ActivationScalar<T>::type;
  Gaussian<T> g{};
  g.mean = raw.mean;
  for (int axis = 0; axis < 3; ++axis) g.scale[axis] = T(exp_of(Wide(raw.log_scale[axis])));
  const Wide q[4] = {Wide(raw.quat[0]), Wide(raw.quat[1]), Wide(raw.quat[2]), Wide(raw.quat[3])};
  const Wide length = sqrt_of(Wide(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]));
  for (std::size_t k = 0; k < 4; ++k) g.quat[k] = T(q[k] / length);
  const Wide one = constant<Wide>(1);
  g.opacity = T(one / Wide(one + exp_of(Wide(-Wide(raw.opacity_logit)))));
  return g;
}

// A whole cloud, in parallel. The reader has refused zero quaternions and values that are not
// finite.
ActivatedCloud activate(const GaussianCloud& cloud);

// The same for the Gaussians of the given indices only: makes `activated` what the whole cloud's
// activation is where nothing but those changed since.
void reactivate(const GaussianCloud& cloud, const std::vector<std::uint32_t>& indices,
                ActivatedCloud& activated);

// The way back: log_scale = ln(scale), logit = ln(opacity / (1 - opacity)), each the nearest float.
// Activation of the result is within a few units in the last place: not every scale, opacity and
// unit quaternion is one that floats of a file lead to. 0 and 1 come back as they are.
GaussianCloud deactivate(const ActivatedCloud& cloud);

// ln(scale), of 0 a number whose exponential is 0 as a float.
float log_scale_of(float scale);

}  // namespace sgs
