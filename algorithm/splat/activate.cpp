// Activation of a whole cloud, in parallel.
#include "algorithm/splat/activate.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cmath>

namespace sgs {
namespace {

Gaussian<float> activate_one(const GaussianCloud& cloud, std::size_t i) {
  Gaussian<float> g{};
  g.mean = cloud.means[i];
  for (int axis = 0; axis < 3; ++axis) {
    g.scale[axis] = static_cast<float>(std::exp(static_cast<double>(cloud.log_scales[i][axis])));
  }
  const auto& q = cloud.quats[i];
  double length = 0;
  for (const float component : q) length += static_cast<double>(component) * component;
  length = std::sqrt(length);
  for (std::size_t k = 0; k < 4; ++k) g.quat[k] = static_cast<float>(q[k] / length);
  g.opacity =
      static_cast<float>(1.0 / (1.0 + std::exp(-static_cast<double>(cloud.opacity_logits[i]))));
  return g;
}

}  // namespace

ActivatedCloud activate(const GaussianCloud& cloud) {
  ActivatedCloud out;
  out.sh_degree = cloud.sh_degree;
  out.gaussians.resize(cloud.size());
  out.sh_coeffs = cloud.sh_coeffs;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, cloud.size(), 4096), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      out.gaussians[i] = activate_one(cloud, i);
    }
  });
  return out;
}

}  // namespace sgs
