// Sums over pairs out of order, and over what groups fetch.
#include "algorithm/tune/additional_losses.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "algorithm/render/blend_watch.h"
#include "algorithm/render/group_state.h"
#include "algorithm/tune/gaussian_gradient.h"

namespace sgs {

namespace {

struct GroupPenalty {
  double sum = 0;  // sum of T_i S_i
  std::uint64_t rendered = 0;
  std::vector<std::uint32_t> misordered;  // positions in the splats
};

int largest_axis(const glm::vec3& scale) {
  return scale.x >= scale.y ? (scale.x >= scale.z ? 0 : 2) : (scale.y >= scale.z ? 1 : 2);
}

GroupPenalty penalty_of(const GroupSequences& sequences, std::size_t group,
                        const ActivatedCloud& cloud, BlendPrecision precision, MisorderedIn in) {
  GroupPenalty out;
  GroupState state(sequences.groups[group], sequences.width, sequences.height, precision);
  BlendWatch watch(state.subtile_count());
  float deepest = 0;
  for (std::size_t i = sequences.first[group]; i != sequences.first[group + 1]; ++i) {
    if (state.saturated()) break;
    const Splat& splat = sequences.splat_of(i);
    const std::uint64_t before = watch.misordered();
    bool rendered = false;
    state.blend(splat, [&](const SubtileBlend& blend) {
      if (watch.see(blend, splat.depth)) rendered = true;
    });
    if (!rendered) continue;
    ++out.rendered;
    const bool at_a_pixel = watch.misordered() != before;
    if (in == MisorderedIn::kPixel ? at_a_pixel : splat.depth < deepest) {
      const glm::vec3& scale = cloud.gaussians[splat.index].scale;
      out.sum += scale[largest_axis(scale)];
      out.misordered.push_back(sequences.entries[i]);
    }
    deepest = std::max(deepest, splat.depth);
  }
  return out;
}

std::vector<std::uint32_t> gaussians_of(const GroupSequences& sequences) {
  std::vector<std::uint32_t> out;
  out.reserve(sequences.splats.size());
  for (const Splat& splat : sequences.splats) out.push_back(splat.index);
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

BoundaryPenalty boundary_penalty(const GroupSequences& sequences, const ActivatedCloud& cloud,
                                 BlendPrecision precision, const BoundaryPenaltyConfig& config) {
  std::vector<GroupPenalty> parts(sequences.groups.size());
  tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t group) {
    parts[group] = penalty_of(sequences, group, cloud, precision, config.in);
  });
  BoundaryPenalty out;
  out.groups.resize(sequences.splats.size());
  double sum = 0;
  for (const GroupPenalty& part : parts) {
    sum += part.sum;
    out.rendered += part.rendered;
    out.misordered += part.misordered.size();
    for (const std::uint32_t position : part.misordered) ++out.groups[position];
  }
  out.count =
      static_cast<double>(config.mean == PenaltyMean::kRendered ? out.rendered : cloud.size());
  if (out.count > 0) out.value = sum / out.count;
  return out;
}

void add_boundary_gradient(const BoundaryPenalty& penalty, double beta,
                           const GroupSequences& sequences, const ActivatedCloud& cloud,
                           CloudGradient& gradient) {
  std::vector<std::uint32_t> rank_of(cloud.size());
  for (std::size_t r = 0; r != gradient.size(); ++r) {
    rank_of[gradient.indices[r]] = static_cast<std::uint32_t>(r);
  }
  for (std::size_t at = 0; at != penalty.groups.size(); ++at) {
    if (penalty.groups[at] == 0) continue;
    const std::uint32_t i = sequences.splats[at].index;
    const glm::vec3& scale = cloud.gaussians[i].scale;
    const int axis = largest_axis(scale);
    // dS/dlog S = S.
    gradient.parameters.log_scales[rank_of[i]][axis] +=
        static_cast<float>(beta * penalty.groups[at] * scale[axis] / penalty.count);
  }
}

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
