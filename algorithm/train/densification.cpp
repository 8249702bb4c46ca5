#include "algorithm/train/densification.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <numeric>

#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/splat/activate.h"
#include "algorithm/splat/gaussian.h"
#include "algorithm/train/counter_random.h"

namespace sgs {
namespace {

constexpr double kSplitShrinks = 1.6;

// Three deviations along the longer axis.
double radius_px(const Splat& splat) {
  const double a = splat.conic_a, b = splat.conic_b, c = splat.conic_c;
  const double middle = (a + c) / 2;
  // The smaller eigenvalue, as det over the larger: a difference would have no digits of needles.
  const double larger = middle + std::sqrt((a - c) * (a - c) / 4 + b * b);
  const double det = a * c - b * b;
  return det > 0 ? 3 * std::sqrt(larger / det) : 0;
}

// A point of the Gaussian, drawn.
glm::vec3 drawn_from(const Gaussian<float>& g, CounterRandom& random) {
  const glm::dquat turn(g.quat[0], g.quat[1], g.quat[2], g.quat[3]);
  return g.mean + glm::vec3(turn * (glm::dvec3(g.scale) * random.normal3()));
}

// Adds Gaussian `from` once more at the end.
void append(std::uint32_t from, std::vector<std::uint32_t>& order,
            std::vector<std::uint32_t>& moments) {
  order.push_back(from);
  moments.push_back(Adam::kNew);
}

}  // namespace

void DensificationStatistics::clear(std::size_t count) {
  pulls_.assign(count, 0);
  seen_.assign(count, 0);
  radii_px_.assign(count, 0);
}

void DensificationStatistics::add(const GroupSequences& sequences, const CloudGradient& gradient) {
  const float half_x = static_cast<float>(sequences.width) / 2;
  const float half_y = static_cast<float>(sequences.height) / 2;
  for (std::size_t r = 0; r < gradient.size(); ++r) {
    const std::uint32_t i = gradient.indices[r];
    pulls_[i] += std::hypot(gradient.centres[r].x * half_x, gradient.centres[r].y * half_y);
    ++seen_[i];
  }
  for (const Splat& splat : sequences.splats) {
    float& radius = radii_px_[splat.index];
    radius = std::max(radius, static_cast<float>(sgs::radius_px(splat)));
  }
}

double DensificationStatistics::pull(std::size_t i) const {
  return seen_[i] == 0 ? 0 : static_cast<double>(pulls_[i]) / seen_[i];
}

void densify_and_prune(const DensificationConfig& config, const DensificationStatistics& seen,
                       double extent, bool prune_large, std::size_t most, std::uint64_t seed,
                       std::uint64_t step, GaussianCloud& cloud, Adam& adam) {
  const ActivatedCloud activated = activate(cloud);
  const auto largest_scale = [&](std::size_t i) {
    const glm::vec3& s = activated.gaussians[i].scale;
    return std::max({s.x, s.y, s.z});
  };
  std::vector<std::uint32_t> pulled;
  std::vector<char> goes(cloud.size(), 0);
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    const bool faint = activated.gaussians[i].opacity < config.least_opacity;
    const bool large = prune_large && (seen.radius_px(i) > config.most_radius_px ||
                                       largest_scale(i) > config.most_scale_share * extent);
    goes[i] = faint || large;
    if (!goes[i] && seen.pull(i) >= config.pull) pulled.push_back(i);
  }
  const auto stay = static_cast<std::size_t>(std::count(goes.begin(), goes.end(), 0));
  const std::size_t room = most > stay ? most - stay : 0;
  if (pulled.size() > room) {
    std::stable_sort(pulled.begin(), pulled.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return seen.pull(a) > seen.pull(b); });
    pulled.resize(room);
    std::sort(pulled.begin(), pulled.end());
  }

  std::vector<std::uint32_t> split, cloned;
  for (const std::uint32_t i : pulled) {
    const bool small = largest_scale(i) <= config.clone_share * extent;
    (small ? cloned : split).push_back(i);
    if (!small) goes[i] = 1;
  }
  std::vector<std::uint32_t> order, moments;
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    if (goes[i]) continue;
    order.push_back(i);
    moments.push_back(i);
  }
  for (const std::uint32_t i : cloned) append(i, order, moments);
  const std::size_t first_half = order.size();
  for (const std::uint32_t i : split) {
    append(i, order, moments);
    append(i, order, moments);
  }
  cloud = reordered(cloud, order);
  const RandomUse use = RandomUse::kSplit;
  for (std::size_t at = first_half; at < order.size(); ++at) {
    CounterRandom random{seed, use, step, at};
    cloud.means[at] = drawn_from(activated.gaussians[order[at]], random);
    cloud.log_scales[at] -= static_cast<float>(std::log(kSplitShrinks));
  }
  adam.rearrange(moments);
}

void reset_opacities(const DensificationConfig& config, GaussianCloud& cloud, Adam& adam) {
  const auto most = static_cast<float>(logit(config.reset_opacity));
  for (float& own : cloud.opacity_logits) own = std::min(own, most);
  adam.forget_opacities();
}

}  // namespace sgs
