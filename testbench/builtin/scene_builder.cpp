// Dealing out, baking and storing for scene_builder.h.
#include "testbench/builtin/scene_builder.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <numeric>

#include "algorithm/scene/gaussian_cloud.h"

namespace sgs {
namespace {

// First Gaussian of each part, and `count` at the end: rounded sums, so nothing is lost.
std::vector<std::uint64_t> first_of_parts(const std::vector<ScenePart>& parts,
                                          std::uint64_t count) {
  double total = 0;
  for (const ScenePart& part : parts) total += part.share;
  std::vector<std::uint64_t> first = {0};
  double sum = 0;
  for (const ScenePart& part : parts) {
    sum += part.share;
    first.push_back(
        static_cast<std::uint64_t>(std::llround(sum / total * static_cast<double>(count))));
  }
  first.back() = count;
  return first;
}

// A step that visits all of 0 .. count - 1, near the golden section of it.
std::uint64_t scattering_step(std::uint64_t count) {
  auto step = static_cast<std::uint64_t>(0.6180339887498949 * static_cast<double>(count)) | 1u;
  while (std::gcd(step, count) != 1) step += 2;
  return step;
}

void store(const Surfel& surfel, const std::array<glm::dvec3, 16>& coeffs, Random& random,
           std::uint64_t index, GaussianCloud& cloud) {
  constexpr double kLeastSigma = 1e-7;
  cloud.means[index] = glm::vec3(surfel.position);
  for (int axis = 0; axis < 3; ++axis) {
    const double sigma = std::max(surfel.sigmas[axis], kLeastSigma);
    cloud.log_scales[index][axis] = static_cast<float>(std::log(sigma));
  }
  // Training never normalises quaternions: their lengths spread.
  const glm::dquat q = glm::quat_cast(surfel.axes) * random.uniform(0.5, 2.0);
  cloud.quats[index] = {static_cast<float>(q.w), static_cast<float>(q.x), static_cast<float>(q.y),
                        static_cast<float>(q.z)};
  const double opacity = std::clamp(surfel.opacity, 1e-4, 0.9999);
  cloud.opacity_logits[index] = static_cast<float>(logit(opacity));
  // Nor does it leave any coefficient at exactly zero.
  constexpr double kResidue = 0.008;
  for (std::size_t k = 0; k < coeffs.size(); ++k) {
    glm::dvec3 coeff = coeffs[k];
    for (int channel = 0; channel < 3; ++channel)
      coeff[channel] += kResidue * random.uniform(-1, 1);
    cloud.sh_coeffs[index * coeffs.size() + k] = glm::vec3(coeff);
  }
}

}  // namespace

GaussianCloud build_scene(const std::vector<ScenePart>& parts, const Lighting& lighting,
                          std::uint64_t count, std::uint64_t seed) {
  const std::vector<std::uint64_t> first = first_of_parts(parts, count);
  const std::uint64_t step = scattering_step(count);
  GaussianCloud cloud;
  cloud.resize(count, 3);
  tbb::parallel_for(tbb::blocked_range<std::uint64_t>(0, count, 512), [&](const auto& range) {
    for (std::uint64_t i = range.begin(); i != range.end(); ++i) {
      const auto after = std::upper_bound(first.begin(), first.end(), i);
      const auto part = static_cast<std::size_t>(after - first.begin()) - 1;
      Random random(mix_bits(seed) ^ i);
      const Surfel surfel =
          parts[part].surfel({i - first[part], first[part + 1] - first[part]}, random);
      store(surfel, lighting.baked(surfel), random, i * step % count, cloud);
    }
  });
  return cloud;
}

}  // namespace sgs
