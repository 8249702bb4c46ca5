// Surfaces of pond.h; where the pond lies is terrain.h's.
#include "testbench/builtin/pond.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "testbench/builtin/noise.h"
#include "testbench/builtin/patch.h"
#include "testbench/builtin/shapes.h"
#include "testbench/builtin/terrain.h"

namespace sgs {
namespace {

Material water_material(const SurfacePoint& point) {
  const glm::dvec3& p = point.position;
  const double ripple = fractal_noise({p.x * 1.1, 0.0, p.z * 4.5}, 3);
  const double depth = smooth_step(1.0, 0.55, std::hypot(p.x - kPondX, p.z - kPondZ) / kPondRadius);
  const glm::dvec3 bed =
      glm::mix(glm::dvec3(0.20, 0.19, 0.10), glm::dvec3(0.02, 0.08, 0.08), depth);
  return {bed * (0.6 + 0.8 * ripple), glm::dvec3(0.50, 0.54, 0.56) * (0.55 + 0.9 * ripple), {}};
}

// A round leaf that floats; some carry a flower.
void add_lily(Random& random, double share, std::vector<ScenePart>& parts) {
  const double away = kPondRadius * random.uniform(0.35, 0.80), turn = random.uniform(2.2, 4.6);
  const double size = random.uniform(0.12, 0.24);
  const glm::dvec3 centre = at_height(kPondX + away * std::cos(turn), kWaterHeight + 0.02,
                                      kPondZ + away * std::sin(turn));
  const double tint = random.uniform(0.7, 1.2);
  parts.push_back(patch_part(0.7 * share, disc_map(centre, size), [tint](const SurfacePoint& p) {
    const double vein = 0.8 + 0.2 * std::cos(2.0 * M_PI * 9.0 * p.uv.x);
    return Material{glm::dvec3(0.20, 0.42, 0.12) * (tint * vein), glm::dvec3(0.06), {}};
  }));
  const glm::dvec3 flower = centre + kUp * 0.05;
  parts.push_back(
      patch_part(0.3 * share, sphere_map(flower, 0.3 * size), [](const SurfacePoint& p) {
        const bool heart = p.uv.y > 0.8;
        return Material{heart ? glm::dvec3(0.95, 0.8, 0.2) : glm::dvec3(0.95, 0.75, 0.82), {}, {}};
      }));
}

// Stalks in clumps along the shore.
Surfel reed(const PartSample& sample, Random& random) {
  const double clump = std::floor(random.uniform(0.0, 11.0));
  const double turn = 2.4 * clump + 0.16 * random.normal();
  const double away = kPondRadius * (1.02 + 0.07 * random.normal());
  const double x = kPondX + away * std::cos(turn), z = kPondZ + away * std::sin(turn);
  const double tall = random.uniform(0.3, 0.75);
  const double lean_z = random.normal(), lean_x = random.normal();
  const glm::dvec3 along = glm::normalize(kUp + 0.22 * glm::dvec3(lean_x, 0.0, lean_z));
  const glm::dvec3 across = glm::normalize(glm::cross(along, random.direction()));
  const glm::dvec3 root = at_height(x, std::max(ground_height(x, z), kWaterHeight), z);
  Surfel surfel;
  surfel.axes = glm::dmat3(along, across, glm::cross(along, across));
  surfel.sigmas = glm::dvec3(0.42 * tall, 0.014 * thinning(sample, 1800), 0.003);
  surfel.position = root + along * (0.8 * tall);
  surfel.opacity = random.uniform(0.4, 0.98);
  const bool head = random.uniform() < 0.12 * thinning(sample, 1800);
  if (head) {
    surfel.sigmas = {0.07, 0.022, 0.022};
    surfel.position = root + along * (1.7 * tall);
  }
  surfel.material.albedo =
      head ? glm::dvec3(0.30, 0.18, 0.09) : glm::dvec3(0.33, 0.45, 0.15) * random.uniform(0.6, 1.3);
  surfel.material.reflectance = glm::dvec3(0.07);
  return surfel;
}

}  // namespace

std::vector<ScenePart> pond_parts(double share) {
  PatchLook calm;
  calm.opacity_low = 0.9;
  calm.edge_contrast = kNoEdges;
  const glm::dvec3 middle = at_height(kPondX, kWaterHeight, kPondZ);
  std::vector<ScenePart> parts = {
      patch_part(0.55 * share, disc_map(middle, 1.15 * kPondRadius), water_material, calm),
      {0.20 * share, reed}};
  constexpr int kLilies = 22;
  Random random(99);
  for (int i = 0; i < kLilies; ++i) add_lily(random, 0.25 * share / kLilies, parts);
  return parts;
}

}  // namespace sgs
