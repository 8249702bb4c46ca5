// Dealing out, baking and storing for scene_builder.h.
#include "testbench/builtin/scene_builder.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <numeric>

#include "algorithm/scene/gaussian_cloud.h"
#include "algorithm/splat/spherical_harmonics.h"
#include "testbench/builtin/random.h"

namespace sgs {

namespace {

constexpr int kDegree = 3;
constexpr double kBasis0 = 0.28209479177387814;

void add_lobe(const ZonalLobe& lobe, const glm::dvec3& axis, const glm::dvec3& weight,
              std::array<glm::dvec3, 16>& coeffs) {
  double basis[16];
  sh_basis(kDegree, axis.x, axis.y, axis.z, basis);
  for (int band = 0, k = 0; band <= kDegree; ++band) {
    const glm::dvec3 scaled = weight * lobe.bands[band];
    for (int m = 0; m < 2 * band + 1; ++m, ++k) coeffs[k] += scaled * basis[k];
  }
}

// Light of the sun that passes one occluder on its way to `point`.
double passing(const Capsule& capsule, const glm::dvec3& point, const glm::dvec3& to_sun,
               double softness) {
  const glm::dvec3 along = capsule.to - capsule.from, offset = point - capsule.from;
  const double length2 = glm::dot(along, along);
  // Most rays miss the ball around the capsule by far.
  const glm::dvec3 to_middle = 0.5 * along - offset;
  const double ahead = glm::dot(to_middle, to_sun),
               miss2 = glm::dot(to_middle, to_middle) - ahead * ahead;
  const double reach = 0.5 * std::sqrt(length2) + 1.02 * capsule.radius;
  const double widest = reach + softness * std::max(ahead + reach, 0.0);
  if (ahead < -reach || miss2 > widest * widest) return 1.0;

  // Closest approach of the ray point + s to_sun to the segment from + t along.
  const double projection = glm::dot(along, to_sun);
  const double denominator = length2 - projection * projection;
  double t = 0;
  if (denominator > 1e-12) {
    t = (glm::dot(offset, along) - glm::dot(offset, to_sun) * projection) / denominator;
    t = std::clamp(t, 0.0, 1.0);
  }
  const glm::dvec3 to_axis = along * t - offset;
  const double distance = glm::dot(to_axis, to_sun);
  if (distance < -capsule.radius) return 1.0;
  const double miss = glm::length(to_axis - to_sun * std::max(distance, 0.0));
  const double penumbra = softness * std::max(distance, 0.0) + 0.02 * capsule.radius;
  return smooth_step(capsule.radius - penumbra, capsule.radius + penumbra, miss);
}

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

ZonalLobe spot_lobe(const glm::dvec3& axis, double sharpness, const glm::dvec3& colour) {
  ZonalLobe lobe{axis, {}};
  const double mean = 2.0 * M_PI / sharpness * (1.0 - std::exp(-2.0 * sharpness));
  for (int band = 0; band <= kDegree; ++band) {
    lobe.bands[band] = colour * (mean * std::exp(-band * (band + 1) / (2.0 * sharpness)));
  }
  return lobe;
}

ZonalLobe gradient_lobe(const glm::dvec3& axis, const glm::dvec3& mean, const glm::dvec3& slope) {
  return {axis, {mean * (4.0 * M_PI), slope * (4.0 * M_PI / 3.0), glm::dvec3(0), glm::dvec3(0)}};
}

double Lighting::sun_visibility(const glm::dvec3& point) const {
  double visible = 1.0;
  for (const Capsule& capsule : occluders) {
    visible *= passing(capsule, point, sun_direction, shadow_softness);
    if (visible < 1e-3) return 0.0;
  }
  return visible;
}

std::array<glm::dvec3, 16> Lighting::baked(const Surfel& surfel) const {
  const glm::dvec3& normal = surfel.shading_normal;
  const double facing = glm::dot(normal, sun_direction);
  // Off the surface by more than its own thickness, or every surface would shade itself.
  const double visible =
      facing > 0 ? sun_visibility(surfel.position + normal * (2.0 * surfel.sigmas.z)) : 0.0;
  const double up = 0.5 - 0.5 * normal.y;
  const glm::dvec3 ambient = (sky_colour * up + ground_colour * (1.0 - up)) * surfel.sky_visibility;
  const glm::dvec3 light = ambient + sun_colour * (std::max(facing, 0.0) * visible);

  std::array<glm::dvec3, 16> coeffs{};
  const glm::dvec3 matte = surfel.material.albedo * light + surfel.material.emission;
  coeffs[0] = (matte - 0.5) / kBasis0;
  if (surfel.material.reflectance == glm::dvec3(0)) return coeffs;
  for (const ZonalLobe& lobe : surroundings) {
    const glm::dvec3 mirrored = lobe.axis - 2.0 * glm::dot(lobe.axis, normal) * normal;
    add_lobe(lobe, mirrored, surfel.material.reflectance * surfel.sky_visibility, coeffs);
  }
  return coeffs;
}

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
