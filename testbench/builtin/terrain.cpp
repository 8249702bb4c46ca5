// Ground, grass, water, lilies and reeds.
#include "testbench/builtin/terrain.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "testbench/builtin/random.h"
#include "testbench/builtin/shapes.h"

namespace sgs {

namespace {

constexpr double kGroundRadius = 900;
// Cells of ground grow with the distance from here, close to the cameras.
constexpr double kCentreX = 0, kCentreZ = -2, kDenseRadius = 3;

glm::dvec3 ground_map(const glm::dvec2& uv) {
  const double growth = std::log(1.0 + kGroundRadius / kDenseRadius);
  const double radius = kDenseRadius * (std::exp(growth * (1.0 - uv.y)) - 1.0);
  const double angle = 2.0 * M_PI * uv.x;
  return ground_point(kCentreX + radius * std::cos(angle), kCentreZ + radius * std::sin(angle));
}

glm::dvec3 meadow_colour(const glm::dvec3& p) {
  const double patches = fractal_noise({p.x * 0.12, 3.0, p.z * 0.12}, 3);
  const double detail = fractal_noise({p.x * 2.3, 9.0, p.z * 2.3}, 3);
  const glm::dvec3 lush(0.16, 0.34, 0.07), dry(0.42, 0.42, 0.14);
  return glm::mix(lush, dry, smooth_step(0.35, 0.7, patches)) * (0.6 + 0.8 * detail);
}

Material ground_material(const SurfacePoint& point) {
  const glm::dvec3& p = point.position;
  const double height = -p.y, steep = 1.0 + point.normal.y;
  const double rough = fractal_noise(p * 0.9, 4);
  glm::dvec3 colour = meadow_colour(p);
  const double forest = smooth_step(30, 90, std::hypot(p.x, p.z));
  colour = glm::mix(colour, glm::dvec3(0.09, 0.20, 0.07) * (0.6 + 0.8 * rough), forest);
  const double sand =
      1.0 - smooth_step(0.55, 0.95, distance_from_path(p.x, p.z) + 0.5 * (rough - 0.5));
  colour = glm::mix(colour, glm::dvec3(0.62, 0.50, 0.34) * (0.7 + 0.6 * rough), sand);
  const double shore = std::hypot(p.x - kPondX, p.z - kPondZ) - kPondRadius;
  const double mud = 1.0 - smooth_step(0.1, 0.6, shore + 0.4 * (rough - 0.5));
  colour = glm::mix(colour, glm::dvec3(0.33, 0.27, 0.18) * (0.7 + 0.6 * rough), mud);
  const glm::dvec3 rock = glm::dvec3(0.40, 0.37, 0.35) * (0.5 + rough);
  colour = glm::mix(colour, rock, smooth_step(0.10, 0.26, steep + 0.2 * (rough - 0.5)));
  const double snow =
      smooth_step(62, 90, height + 50 * (rough - 0.5)) * (1.0 - smooth_step(0.3, 0.6, steep));
  colour = glm::mix(colour, glm::dvec3(0.95, 0.96, 1.0), snow);

  // Behind haze a surface is partly its own colour in the light and partly the air before it.
  const glm::dvec3 air = hazed(glm::dvec3(0), p);
  return {hazed(colour, p) - air, glm::dvec3(0.03), air};
}

// A blade of grass: a needle that leans, brighter towards the tip.
Surfel grass_blade(const PartSample& sample, Random& random) {
  const glm::dvec2 uv = even_point(sample.index);
  Surfel surfel;
  const double angle = 2.0 * M_PI * uv.x, radius = 18.0 * std::pow(uv.y, 0.8);
  const double x = kCentreX + radius * std::cos(angle), z = kCentreZ + radius * std::sin(angle);
  const double tall = random.uniform(0.05, 0.16);
  const glm::dvec3 root = ground_point(x, z);
  const bool bare = distance_from_path(x, z) < 0.8 || -root.y < kWaterHeight + 0.08;
  const double lean_z = random.uniform(-0.4, 0.4), lean_x = random.uniform(-0.4, 0.4);
  const glm::dvec3 lean(lean_x, -1.0, lean_z);
  const glm::dvec3 along = glm::normalize(lean);
  const glm::dvec3 across = glm::normalize(glm::cross(along, random.direction()));
  surfel.axes = glm::dmat3(along, across, glm::cross(along, across));
  const double size = std::min(3.0, std::sqrt(30000.0 / static_cast<double>(sample.count)));
  surfel.sigmas = glm::dvec3(0.5 * tall, 0.012 * size, 0.002) * (bare ? 0.3 : 1.0);
  surfel.position = root + along * tall;
  surfel.opacity = random.uniform(0.35, 0.98);
  const bool flower = !bare && random.uniform() < 0.03 * thinning(sample, 30000);
  const glm::dvec3 green = meadow_colour(root) * random.uniform(1.0, 1.7);
  surfel.material.albedo = green;
  if (bare) surfel.material.albedo = glm::dvec3(0.5, 0.42, 0.3) * random.uniform(0.6, 1.2);
  if (flower) {
    surfel.sigmas = glm::dvec3(0.03) * random.uniform(0.7, 1.2);
    surfel.material.albedo =
        random.uniform() < 0.5 ? glm::dvec3(0.95, 0.85, 0.2) : glm::dvec3(0.95, 0.93, 0.95);
  }
  surfel.material.reflectance = glm::dvec3(0.07);
  return surfel;
}

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

double distance_from_path(double x, double z) {
  if (z > 6.2) return std::hypot(x - (-4.0), z - 6.2);
  return std::abs(x - (-4.0 + 0.012 * (6.2 - z) * (6.2 - z) + 0.9 * std::sin(0.45 * (6.2 - z)))) *
         0.8;
}

double ground_height(double x, double z) {
  const double radius = std::hypot(x, z);
  const double far = smooth_step(14, 60, radius), farther = smooth_step(130, 480, radius);
  const double bumps = 0.35 * (fractal_noise({x * 0.25, 0.0, z * 0.25}, 3) - 0.5);
  double height = bumps;
  if (far > 0) height += far * 9.0 * (fractal_noise({x * 0.028, 5.0, z * 0.028}, 3) - 0.42);
  if (farther > 0) {
    // Folded noise has sharp crests. No finer octaves than the far cells of ground can show.
    const double fold = 1.0 - std::abs(2.0 * fractal_noise({x * 0.0045, 8.0, z * 0.0045}, 3) - 1.0);
    height += farther * 190.0 * (fold * fold - 0.35);
  }
  // The basin of the pond.
  const double shore = std::hypot(x - kPondX, z - kPondZ) / kPondRadius;
  return height - 1.1 * (1.0 - smooth_step(0.55, 1.3, shore));
}

glm::dvec3 ground_point(double x, double z) { return at_height(x, ground_height(x, z), z); }

glm::dvec3 hazed(const glm::dvec3& colour, const glm::dvec3& position) {
  const glm::dvec3 haze(0.66, 0.75, 0.86);
  const double clear = std::exp(-std::max(glm::length(position) - 20.0, 0.0) / 620.0);
  return glm::mix(haze, colour, clear);
}

std::vector<ScenePart> terrain_parts(double share) {
  PatchLook soil;
  soil.edge_contrast = kNoEdges;
  return {patch_part(0.65 * share, ground_map, ground_material, soil), {0.35 * share, grass_blade}};
}

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
