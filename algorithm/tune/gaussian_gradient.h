// From a splat's gradient to that of the Gaussian that it is the picture of.
#pragma once

#include "algorithm/splat/view.h"
#include "algorithm/tune/colour_gradient.h"
#include "algorithm/tune/projection_gradient.h"

namespace sgs {

// dL/d of g as the datapath computes with it, and into by_sh [(degree+1)^2] rgb dL/d of its
// coefficients sh. For what make_geometry() and add_colour() draw; colour: by the latter.
template <class T>
Gaussian<T> gaussian_gradient(const View<T>& view, const Gaussian<T>& g, int sh_degree,
                              const glm::vec<3, T>* sh, const glm::vec<3, T>& colour,
                              const SplatGradient<T>& splat, GradientRule rule,
                              glm::vec<3, T>* by_sh) {
  Gaussian<T> out = projection_gradient(view, g, to_camera(view, g.mean), splat, rule);
  const auto by_offset =
      colour_gradient(sh_degree, sh, from_eye(view, g.mean), colour, splat.rgb, by_sh);
  for (int k = 0; k < 3; ++k) out.mean[k] = T(out.mean[k] + by_offset[k]);
  return out;
}

}  // namespace sgs
