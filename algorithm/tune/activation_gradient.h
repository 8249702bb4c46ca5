// Activations (splat/activate.h), differentiated.
#pragma once

#include "algorithm/splat/activate.h"

namespace sgs {

// dL/d of a file's parameters from dL/d of those of the datapath; g: activate(raw).
template <class T>
RawGaussian<T> activation_gradient(const RawGaussian<T>& raw, const Gaussian<T>& g,
                                   const Gaussian<T>& by) {
  RawGaussian<T> out{};
  out.mean = by.mean;
  for (int axis = 0; axis < 3; ++axis) out.log_scale[axis] = T(by.scale[axis] * g.scale[axis]);

  // sigmoid' = e / (1 + e)^2 with e = exp(-|logit|): 1 - opacity has no digits left near 1.
  const T zero = T(0.0F), one = T(1.0F);
  const T e = exp_of(raw.opacity_logit < zero ? raw.opacity_logit : T(-raw.opacity_logit));
  const T sum = T(one + e);
  out.opacity_logit = T(by.opacity * T(e / T(sum * sum)));

  // u = q / |q|: dL/dq = (dL/du - u (u . dL/du)) / |q|.
  using Wide = typename ActivationScalar<T>::type;
  Wide squares = Wide(0.0F);
  T along = zero;
  for (std::size_t k = 0; k < 4; ++k) {
    squares = Wide(squares + Wide(raw.quat[k]) * Wide(raw.quat[k]));
    along = T(along + by.quat[k] * g.quat[k]);
  }
  const Wide length = sqrt_of(squares);
  for (std::size_t k = 0; k < 4; ++k) {
    out.quat[k] = T(Wide(T(by.quat[k] - along * g.quat[k])) / length);
  }
  return out;
}

}  // namespace sgs
