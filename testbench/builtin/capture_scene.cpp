// Surroundings and cameras of capture_scene.h.
#include "testbench/builtin/capture_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>
#include <vector>

#include "testbench/builtin/plants.h"
#include "testbench/builtin/random.h"
#include "testbench/builtin/scene_builder.h"
#include "testbench/builtin/shapes.h"
#include "testbench/builtin/toy_rocket.h"
#include "testbench/builtin/trained_part.h"

namespace sgs {
namespace {

constexpr double kRingRadius = 4.4, kEyeHeight = 1.5;
constexpr int kWidth = 980, kHeight = 545;  // px, of Tanks and Temples
constexpr double kFieldRadius = 22, kHillRadius = 24, kSkyRadius = 29;
constexpr double kMostOfSky = 3000;  // Gaussians: an even blue needs no more
constexpr int kTrees = 14, kHouses = 8;

glm::dvec3 around(double angle, double radius, double height) {
  return at_height(radius * std::sin(angle), height, radius * std::cos(angle));
}

// Level; as many Gaussians to a pixel of the ring's cameras near and far.
ScenePart ground(double share) {
  const SurfaceMap map = [](const glm::dvec2& uv) {
    constexpr double kNear = 5.0, kReach = kFieldRadius / kNear;
    const double radius = kNear * std::sqrt(std::pow(1.0 + kReach * kReach, uv.y) - 1.0);
    return around(2.0 * M_PI * uv.x, radius, 0.0);
  };
  return patch_part(share, map, [](const SurfacePoint& p) {
    const glm::dvec3& at = p.position;
    const double away = std::hypot(at.x, at.z), grain = fractal_noise(at * 6.0, 3);
    const double across = at.x * 1.25 - std::floor(at.x * 1.25);
    const double along = at.z * 1.25 - std::floor(at.z * 1.25);
    glm::dvec3 stone = glm::dvec3(0.56, 0.54, 0.50) * (0.6 + 0.7 * grain);
    if (std::min(across, along) < 0.06) stone *= 0.5;
    const glm::dvec3 grass = glm::dvec3(0.26, 0.36, 0.13) * (0.4 + 1.1 * grain);
    const double edge = 6.5 + 1.5 * fractal_noise(at * 0.4, 2);
    return Material{glm::mix(stone, grass, smooth_step(edge, edge + 0.3, away)), {}, {}};
  });
}

void add_house(double angle, Random& random, double share, std::vector<ScenePart>& parts) {
  const double away = random.uniform(17.0, 23.0), height = random.uniform(4.0, 7.0);
  const glm::dvec3 middle = around(angle, away, height);
  const glm::dvec3 in = -glm::normalize(glm::dvec3(middle.x, 0.0, middle.z));
  const glm::dvec3 along = glm::cross(glm::dvec3(0.0, 1.0, 0.0), in);
  const glm::dvec3 tint =
      glm::mix(glm::dvec3(0.80, 0.72, 0.58), glm::dvec3(0.58, 0.30, 0.22), random.uniform());
  const MaterialMap paint = [tint](const SurfacePoint& p) {
    const double grain = fractal_noise(p.position * 3.0, 3);
    const double column = p.uv.x * 7.0 - std::floor(p.uv.x * 7.0);
    const double row = p.uv.y * 4.0 - std::floor(p.uv.y * 4.0);
    const bool window = std::abs(column - 0.5) < 0.22 && std::abs(row - 0.5) < 0.28;
    if (window) return Material{glm::dvec3(0.08, 0.10, 0.13), glm::dvec3(0.3), {}};
    return Material{tint * (0.7 + 0.5 * grain), {}, {}};
  };
  const glm::dvec3 half_x = along * random.uniform(3.0, 4.5), half_z = in * 2.0;
  for (SurfaceMap& map : box_maps(middle, half_x, glm::dvec3(0.0, height, 0.0), half_z))
    parts.push_back(patch_part(share / 6.0, std::move(map), paint));
}

// A wall of wooded hills that ends the view.
ScenePart hills(double share) {
  const SurfaceMap map = [](const glm::dvec2& uv) {
    const double angle = 2.0 * M_PI * uv.x;
    const double crest = 3.0 + 4.0 * fractal_noise(around(angle, 3.0, 2.0), 3);
    return around(angle, kHillRadius + 4.0 * uv.y, crest * uv.y);
  };
  return patch_part(share, map, [](const SurfacePoint& p) {
    const double grain = fractal_noise(p.position * 0.9, 4);
    return Material{glm::dvec3(0.20, 0.29, 0.16) * (0.4 + 1.2 * grain), {}, {}};
  });
}

// As far up as a camera of the ring sees: training puts nothing where no picture looks.
ScenePart sky(double share) {
  const SurfaceMap inside = [](const glm::dvec2& uv) {
    return around(2.0 * M_PI * uv.x, kSkyRadius, 3.0 + 8.0 * uv.y);
  };
  const auto paint = [](const SurfacePoint& p) {
    const double cloud = smooth_step(0.5, 0.75, fractal_noise(p.position * 0.1, 4));
    return Material{
        {}, {}, glm::mix(glm::dvec3(0.45, 0.62, 0.85), glm::dvec3(0.93, 0.94, 0.96), cloud)};
  };
  return patch_part(share, inside, paint, {0.08, 1.0, 0.9, 1.0, kNoEdges});
}

// Faint ones in the air that the cameras' ring encloses.
ScenePart floaters(double share) {
  return {share, [](const PartSample& sample, Random& random) {
            Surfel surfel;
            const double away = random.uniform(0.5, 12.0), angle = random.uniform(0.0, 2.0 * M_PI);
            surfel.position = around(angle, away, random.uniform(0.1, 3.0));
            surfel.sigmas = glm::dvec3(0.02) * thinning(sample, 20'000);
            surfel.opacity = 0.06;
            surfel.material.emission = glm::dvec3(0.4) * random.uniform(0.3, 1.5);
            return surfel;
          }};
}

Plants trees() {
  Random random(31);
  Plants plants;
  for (int i = 0; i < kTrees; ++i) {
    const double angle = 2.0 * M_PI * (i + random.uniform(-0.3, 0.3)) / kTrees;
    plants.leaf_trees.push_back(leaf_tree(around(angle, random.uniform(9.0, 15.0), 0.0), random));
  }
  return plants;
}

std::vector<ScenePart> capture_parts(const Plants& plants, std::uint64_t count) {
  std::vector<ScenePart> even = toy_rocket_parts(0.05);
  even.push_back(ground(0.22));
  for (ScenePart& part : plant_parts(plants, 0.27)) even.push_back(std::move(part));
  Random random(32);
  for (int i = 0; i < kHouses; ++i)
    add_house(2.0 * M_PI * (i + 0.5) / kHouses, random, 0.32 / kHouses, even);
  even.push_back(hills(0.12));
  even.push_back(floaters(0.01));
  std::vector<ScenePart> parts = {sky(std::min(0.02, kMostOfSky / static_cast<double>(count)))};
  for (ScenePart& part : even) parts.push_back(trained_part(std::move(part)));
  return parts;
}

Lighting noon_light(const Plants& plants) {
  Lighting light;
  light.sun_direction = glm::normalize(at_height(0.5, 1.0, -0.4));
  light.sun_colour = {0.90, 0.86, 0.76};
  light.sky_colour = {0.40, 0.45, 0.54};
  light.ground_colour = {0.20, 0.19, 0.17};
  light.surroundings = {
      gradient_lobe(at_height(0, 1, 0), glm::dvec3(0.40, 0.45, 0.50), glm::dvec3(0.1, 0.16, 0.25)),
      spot_lobe(light.sun_direction, 9.0, glm::dvec3(2.2, 2.0, 1.7))};
  light.occluders = toy_rocket_occluders();
  const std::vector<Capsule> of_plants = plant_occluders(plants);
  light.occluders.insert(light.occluders.end(), of_plants.begin(), of_plants.end());
  return light;
}

Camera on_ring(int id, double angle) {
  Camera camera = look_at(id, fmt::format("ring_{}", id), around(angle, kRingRadius, kEyeHeight),
                          at_height(0, 1.1, 0), 63);
  const double stretch = static_cast<double>(kWidth) / camera.width;
  camera.width = kWidth;
  camera.height = kHeight;
  camera.focal_x *= stretch;
  camera.focal_y *= stretch;
  return camera;
}

}  // namespace

BuiltinScene make_capture_scene(std::uint64_t count) {
  constexpr int kViews = 4;
  const Plants plants = trees();
  BuiltinScene scene;
  scene.cloud = build_scene(capture_parts(plants, count), noon_light(plants), count, 3);
  for (int i = 0; i < kViews; ++i)
    scene.cameras.push_back(on_ring(i, 2.0 * M_PI * (i + 0.3) / kViews));
  return scene;
}

BuiltinPath capture_ring() {
  constexpr int kKeys = 36;
  BuiltinPath path{"ring", {}, true};
  for (int i = 0; i < kKeys; ++i) path.keys.push_back(on_ring(i, 2.0 * M_PI * i / kKeys));
  return path;
}

}  // namespace sgs
