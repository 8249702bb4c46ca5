// The counting behind describe.h.
#include "algorithm/scene/describe.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "algorithm/scene/gaussian_cloud.h"

namespace sgs {
namespace {

// Value of nearest rank at `quantile` (0 to 1); reorders `values`, which must not be empty.
float quantile_of(std::vector<float>& values, double quantile) {
  const auto last = static_cast<double>(values.size() - 1);
  const auto rank = static_cast<std::ptrdiff_t>(std::llround(quantile * last));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

void measure_extents(const GaussianCloud& cloud, SceneSummary& summary) {
  std::vector<float> values(cloud.size());
  for (int axis = 0; axis < 3; ++axis) {
    std::transform(cloud.means.begin(), cloud.means.end(), values.begin(),
                   [axis](const glm::vec3& mean) { return mean[axis]; });
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    summary.extent.min[axis] = *least;
    summary.extent.max[axis] = *most;
    summary.inner_extent.min[axis] = quantile_of(values, 0.001);
    summary.inner_extent.max[axis] = quantile_of(values, 0.999);
  }
}

void measure_scales(const GaussianCloud& cloud, SceneSummary& summary) {
  std::vector<float> largest(cloud.size());
  double largest_log_ratio = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const glm::vec3& log_scale = cloud.log_scales[i];
    const auto [least, most] = std::minmax({log_scale.x, log_scale.y, log_scale.z});
    largest[i] = most;
    largest_log_ratio =
        std::max(largest_log_ratio, static_cast<double>(most) - static_cast<double>(least));
  }
  summary.max_scale_ratio = std::exp(largest_log_ratio);
  summary.max_scale =
      std::exp(static_cast<double>(*std::max_element(largest.begin(), largest.end())));
  summary.median_scale = std::exp(static_cast<double>(quantile_of(largest, 0.5)));
}

void measure_opacities(const GaussianCloud& cloud, SceneSummary& summary) {
  for (const float logit : cloud.opacity_logits) {
    if (sigmoid(logit) < 1.0 / 255.0) ++summary.invisible_count;
  }
  std::vector<float> logits = cloud.opacity_logits;
  summary.median_opacity = sigmoid(quantile_of(logits, 0.5));
}

}  // namespace

SceneSummary summarise(const GaussianCloud& cloud) {
  constexpr std::uint64_t kFirstHalfValues = 4;  // x, y, z, largest scale
  SceneSummary summary;
  summary.count = cloud.size();
  summary.sh_degree = cloud.sh_degree;
  // Position 3, scale 3, rotation 4, opacity 1 and the SH coefficients of three channels.
  const std::uint64_t values = 11 + 3 * static_cast<std::uint64_t>(sh_coeff_count(cloud.sh_degree));
  summary.first_half_bytes = cloud.size() * kFirstHalfValues * sizeof(float);
  summary.second_half_bytes = cloud.size() * (values - kFirstHalfValues) * sizeof(float);
  if (cloud.size() == 0) return summary;
  measure_extents(cloud, summary);
  measure_scales(cloud, summary);
  measure_opacities(cloud, summary);
  return summary;
}

}  // namespace sgs
