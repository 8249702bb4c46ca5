// Logarithms in double, rounded once.
#include "algorithm/splat/deactivate.h"

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
