#include "algorithm/tune/streaming_price.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "algorithm/tune/gaussian_gradient.h"

namespace sgs {
namespace {

std::vector<std::uint32_t> gaussians_of(const GroupSequences& sequences) {
  std::vector<std::uint32_t> out;
  out.reserve(sequences.splats.size());
  for (const Splat& splat : sequences.splats) out.push_back(splat.index);
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

double add_streaming_gradient(const View<float>& view, const GroupSequences& sequences,
                              const GaussianCloud& parameters, const ActivatedCloud& cloud,
                              const PixelSize& group, double weight, CloudGradient& gradient) {
  gradient.add_rows(gaussians_of(sequences));
  const double count = static_cast<double>(cloud.size());
  const auto share = static_cast<float>(weight / count);
  std::vector<double> prices(gradient.size());
  GaussianCloud& by = gradient.parameters;
  const tbb::blocked_range<std::size_t> ranks(0, gradient.size(), 256);
  tbb::parallel_for(ranks, [&](const auto& range) {
    for (std::size_t r = range.begin(); r != range.end(); ++r) {
      const std::uint32_t i = gradient.indices[r];
      const Gaussian<float>& g = cloud.gaussians[i];
      const glm::vec3 v = to_camera(view, g.mean);
      const auto price =
          streaming_price(project(view, g, v), g.opacity, group, {view.width, view.height});
      prices[r] = price.value;
      const auto own = activation_gradient(
          raw_gaussian(parameters, i), g,
          projection_gradient(view, g, v, price.by_splat, GradientRule::kDerivative));
      by.means[r] += share * own.mean;
      by.log_scales[r] += share * own.log_scale;
      for (std::size_t k = 0; k < 4; ++k) by.quats[r][k] += share * own.quat[k];
      by.opacity_logits[r] += share * own.opacity_logit;
    }
  });
  return std::accumulate(prices.begin(), prices.end(), 0.0) / count;
}

}  // namespace sgs
