// Activation of a whole cloud, and back: logarithms in double, rounded once.
#include "algorithm/splat/activate.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "algorithm/scene/gaussian_cloud.h"

namespace sgs {
namespace {

constexpr double kFar = 200;  // exp(-200) is 0 as a float

float logit_of(float opacity) {
  return static_cast<float>(std::clamp(logit(opacity), -kFar, kFar));
}

}  // namespace

ActivatedCloud activate(const GaussianCloud& cloud) {
  ActivatedCloud out;
  out.sh_degree = cloud.sh_degree;
  out.gaussians.resize(cloud.size());
  out.sh_coeffs = cloud.sh_coeffs;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, cloud.size(), 4096), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      out.gaussians[i] = activate(raw_gaussian(cloud, i));
    }
  });
  return out;
}

void reactivate(const GaussianCloud& cloud, const std::vector<std::uint32_t>& indices,
                ActivatedCloud& activated) {
  const auto coeffs = static_cast<std::size_t>(sh_coeff_count(cloud.sh_degree));
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, indices.size(), 512), [&](const auto& range) {
        for (std::size_t r = range.begin(); r != range.end(); ++r) {
          const std::size_t i = indices[r];
          activated.gaussians[i] = activate(raw_gaussian(cloud, i));
          std::copy_n(&cloud.sh_coeffs[i * coeffs], coeffs, &activated.sh_coeffs[i * coeffs]);
        }
      });
}

float log_scale_of(float scale) {
  return static_cast<float>(std::max(std::log(static_cast<double>(scale)), -kFar));
}

GaussianCloud deactivate(const ActivatedCloud& cloud) {
  GaussianCloud out;
  out.resize(cloud.size(), cloud.sh_degree);
  out.sh_coeffs = cloud.sh_coeffs;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, cloud.size(), 4096), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      const Gaussian<float>& g = cloud.gaussians[i];
      out.means[i] = g.mean;
      out.log_scales[i] = {log_scale_of(g.scale.x), log_scale_of(g.scale.y),
                           log_scale_of(g.scale.z)};
      out.quats[i] = g.quat;
      out.opacity_logits[i] = logit_of(g.opacity);
    }
  });
  return out;
}

}  // namespace sgs
