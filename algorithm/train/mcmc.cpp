
#include "algorithm/train/mcmc.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <numeric>
#include <vector>

#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/train/counter_random.h"

namespace sgs {
namespace {

constexpr int kMostShares = 51;
// Nearer to 1 logits lose their digits.
constexpr double kMostOpacity = 1 - 1e-6;

// Indices drawn in proportion to opacity, those of at most kDeadOpacity never.
class Drawing {
 public:
  explicit Drawing(const GaussianCloud& cloud) : sums_(cloud.size()) {
    double sum = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const double opacity = sigmoid(cloud.opacity_logits[i]);
      if (opacity > kDeadOpacity) sum += opacity;
      sums_[i] = sum;
    }
  }
  bool empty() const { return sums_.empty() || sums_.back() == 0; }
  std::uint32_t draw(CounterRandom& random) const {
    const double at = random.uniform() * sums_.back();
    return static_cast<std::uint32_t>(std::upper_bound(sums_.begin(), sums_.end(), at) -
                                      sums_.begin());
  }

 private:
  std::vector<double> sums_;  // [N] of what stands up to here
};

void copy_gaussian(const GaussianCloud& from, std::size_t source, GaussianCloud& to,
                   std::size_t target) {
  const auto coeffs = static_cast<std::size_t>(sh_coeff_count(from.sh_degree));
  to.means[target] = from.means[source];
  to.log_scales[target] = from.log_scales[source];
  to.quats[target] = from.quats[source];
  to.opacity_logits[target] = from.opacity_logits[source];
  std::copy_n(&from.sh_coeffs[source * coeffs], coeffs, &to.sh_coeffs[target * coeffs]);
}

// Puts shares of drawn Gaussians at `places`, the first of them drawn for the first place and so
// on.
void put_shares(const std::vector<std::uint32_t>& places, const Drawing& drawing,
                CounterRandom random, GaussianCloud& cloud, Adam& adam) {
  std::vector<std::uint32_t> sources(places.size());
  std::vector<int> counts(cloud.size(), 1);
  for (std::uint32_t& source : sources) {
    source = drawing.draw(random);
    ++counts[source];
  }
  std::vector<std::uint32_t> from(cloud.size());
  std::iota(from.begin(), from.end(), 0);
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] == 1) continue;
    const Division share = divided(sigmoid(cloud.opacity_logits[i]), counts[i]);
    const double opacity = std::clamp(share.opacity, kDeadOpacity, kMostOpacity);
    cloud.opacity_logits[i] = static_cast<float>(logit(opacity));
    cloud.log_scales[i] += static_cast<float>(std::log(share.scale_factor));
    from[i] = Adam::kNew;
  }
  for (std::size_t k = 0; k < places.size(); ++k) {
    copy_gaussian(cloud, sources[k], cloud, places[k]);
    from[places[k]] = Adam::kNew;
  }
  adam.rearrange(from);
}

}  // namespace

Division divided(double opacity, int count) {
  const int n = std::min(count, kMostShares);
  const double each = 1 - std::pow(1 - opacity, 1.0 / n);
  double sum = 0;
  for (int i = 1; i <= n; ++i) {
    double term = each;  // C(i - 1, k) (-1)^k each^(k + 1)
    for (int k = 0; k < i; ++k) {
      sum += term / std::sqrt(k + 1.0);
      term *= -each * (i - 1 - k) / (k + 1);
    }
  }
  return {each, opacity / sum};
}

std::size_t relocate_dead(GaussianCloud& cloud, Adam& adam, std::uint64_t seed,
                          std::uint64_t step) {
  const Drawing drawing(cloud);
  if (drawing.empty()) return 0;
  std::vector<std::uint32_t> dead;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (sigmoid(cloud.opacity_logits[i]) <= kDeadOpacity) {
      dead.push_back(static_cast<std::uint32_t>(i));
    }
  }
  if (dead.empty()) return 0;
  const RandomUse use = RandomUse::kRelocate;
  put_shares(dead, drawing, CounterRandom{seed, use, step}, cloud, adam);
  return dead.size();
}

void add_shares(std::size_t count, GaussianCloud& cloud, Adam& adam, std::uint64_t seed,
                std::uint64_t step) {
  const Drawing drawing(cloud);
  if (drawing.empty() || count == 0) return;
  const std::size_t before = cloud.size();
  cloud.resize(before + count, cloud.sh_degree);
  std::vector<std::uint32_t> places(count);
  std::iota(places.begin(), places.end(), static_cast<std::uint32_t>(before));
  const RandomUse use = RandomUse::kGrow;
  put_shares(places, drawing, CounterRandom{seed, use, step}, cloud, adam);
}

namespace {

constexpr double kSteepness = 100, kMiddle = 0.005;
constexpr float kStaysAbove = 0.25F;

// Sigma xi = R S^2 R^T xi.
glm::dvec3 shaped(const Gaussian<float>& g, const glm::dvec3& xi) {
  const glm::dmat3 axes = glm::mat3_cast(glm::dquat(g.quat[0], g.quat[1], g.quat[2], g.quat[3]));
  const glm::dvec3 scale(g.scale);
  return axes * (scale * scale * (glm::transpose(axes) * xi));
}

}  // namespace

std::vector<std::uint32_t> add_position_noise(GaussianCloud& cloud, const ActivatedCloud& activated,
                                              double factor, std::uint64_t seed,
                                              std::uint64_t step) {
  std::vector<std::uint32_t> moved;
  for (std::size_t i = 0; i < activated.size(); ++i) {
    if (activated.gaussians[i].opacity <= kStaysAbove) {
      moved.push_back(static_cast<std::uint32_t>(i));
    }
  }
  const RandomUse use = RandomUse::kNoise;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, moved.size(), 256), [&](const auto& range) {
    for (std::size_t k = range.begin(); k != range.end(); ++k) {
      const std::uint32_t i = moved[k];
      const Gaussian<float>& g = activated.gaussians[i];
      CounterRandom random{seed, use, step, i};
      const double share = 1 / (1 + std::exp(kSteepness * (g.opacity - kMiddle)));
      cloud.means[i] += glm::vec3(factor * share * shaped(g, random.normal3()));
    }
  });
  return moved;
}

}  // namespace sgs
