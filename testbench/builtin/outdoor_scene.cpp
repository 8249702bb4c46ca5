// Light and cameras of outdoor_scene.h.
#include "testbench/builtin/outdoor_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <iterator>
#include <utility>
#include <vector>

#include "testbench/builtin/buildings.h"
#include "testbench/builtin/builtin_scene.h"
#include "testbench/builtin/plants.h"
#include "testbench/builtin/random.h"
#include "testbench/builtin/scene_builder.h"
#include "testbench/builtin/shapes.h"
#include "testbench/builtin/terrain.h"

namespace sgs {

namespace {

constexpr double kOutermost = 20'000;

// Colour of the sky towards `direction` (unit, y down).
glm::dvec3 sky_colour(const glm::dvec3& direction, const glm::dvec3& to_sun) {
  const double up = std::max(-direction.y, 0.0);
  const glm::dvec3 horizon(0.70, 0.79, 0.88), zenith(0.13, 0.32, 0.66);
  glm::dvec3 colour = glm::mix(horizon, zenith, 1.0 - std::exp(-4.0 * up));
  // Clouds lie in a plane overhead, so they crowd towards the horizon.
  const glm::dvec3 plane = direction / (up + 0.16);
  const double cloud = fractal_noise(glm::dvec3(plane.x, 40.0, plane.z) * 1.5, 5);
  const double cover = smooth_step(0.52, 0.74, cloud) * smooth_step(0.0, 0.12, up);
  const glm::dvec3 white = glm::mix(glm::dvec3(0.98, 0.98, 0.97), glm::dvec3(0.66, 0.70, 0.77),
                                    smooth_step(0.62, 0.85, cloud));
  colour = glm::mix(colour, white, 0.9 * cover);
  const double sun = std::max(glm::dot(direction, to_sun), 0.0);
  return colour + glm::dvec3(0.25, 0.20, 0.12) * std::pow(sun, 60.0) +
         glm::dvec3(0.9, 0.85, 0.7) * std::pow(sun, 900.0);
}

glm::dmat3 frame_about(const glm::dvec3& normal, Random& random) {
  const glm::dvec3 along = glm::normalize(glm::cross(normal, random.direction()));
  return {along, glm::cross(normal, along), normal};
}

// Direction for an even point: the upper hemisphere and a little below the horizon.
glm::dvec3 sky_direction(const glm::dvec2& uv) {
  const double height = -0.06 + 1.06 * uv.y, radius = std::sqrt(1.0 - height * height);
  return at_height(radius * std::cos(2.0 * M_PI * uv.x), height,
                   radius * std::sin(2.0 * M_PI * uv.x));
}

Lighting afternoon_light(const Plants& plants) {
  Lighting light;
  light.sun_direction = glm::normalize(at_height(0.75, 0.72, -0.55));
  light.sun_colour = {0.95, 0.88, 0.74};
  light.sky_colour = {0.36, 0.42, 0.52};
  light.ground_colour = {0.16, 0.16, 0.12};
  light.shadow_softness = 0.05;
  const glm::dvec3 up = at_height(0, 1, 0);
  light.surroundings = {
      gradient_lobe(up, glm::dvec3(0.38, 0.46, 0.55), glm::dvec3(0.10, 0.18, 0.30)),
      spot_lobe(light.sun_direction, 9.0, glm::dvec3(2.2, 2.0, 1.6))};
  light.occluders = building_occluders();
  const std::vector<Capsule> trees = plant_occluders(plants);
  light.occluders.insert(light.occluders.end(), trees.begin(), trees.end());
  return light;
}

// A camera at eye height above the ground.
Camera standing_at(int id, const char* name, double x, double z, double height,
                   const glm::dvec3& target) {
  return look_at(id, name, at_height(x, ground_height(x, z) + height, z), target, 65);
}

}  // namespace

std::vector<ScenePart> sky_parts(const glm::dvec3& to_sun, double share) {
  const auto shell = [to_sun](const PartSample& sample, Random& random) {
    const glm::dvec3 direction = sky_direction(even_point(sample.index));
    const double distance = 2500.0 * std::exp(random.uniform(0.0, 0.8));
    Surfel surfel;
    surfel.position = direction * distance;
    surfel.axes = frame_about(direction, random);
    const double spacing = std::sqrt(2.0 * M_PI * 1.06 / static_cast<double>(sample.count));
    const double size = distance * std::min(spacing, 0.6);
    surfel.sigmas = glm::dvec3(0.85, 0.75, 0.1) * size;
    surfel.opacity = random.uniform(0.7, 0.99);
    surfel.material.emission = sky_colour(direction, to_sun);
    return surfel;
  };
  const auto lost = [to_sun](const PartSample&, Random& random) {
    const glm::dvec3 direction = sky_direction({random.uniform(), random.uniform()});
    Surfel surfel;
    surfel.position = direction * (kOutermost * std::sqrt(random.uniform(0.1, 1.0)));
    surfel.axes = frame_about(direction, random);
    surfel.sigmas = glm::dvec3(1.0, 0.5, 0.05) * random.uniform(50.0, 500.0);
    surfel.opacity = random.uniform(0.05, 0.9);
    surfel.material.emission = sky_colour(direction, to_sun);
    return surfel;
  };
  return {{0.985 * share, shell}, {0.015 * share, lost}};
}

std::vector<ScenePart> artefact_parts(double share) {
  const auto floater = [](const PartSample& sample, Random& random) {
    Surfel surfel;
    const double z = -4.0 + 9.0 * random.normal();
    const double y = 0.6 + 3.0 * random.uniform();
    const double x = 9.0 * random.normal();
    surfel.position = at_height(x, y, z);
    surfel.axes = frame_about(random.direction(), random);
    const double size = random.uniform(0.03, 0.3) * thinning(sample, 1600);
    surfel.sigmas = glm::dvec3(1.0, random.uniform(0.2, 1.0), 0.15) * size;
    surfel.opacity = random.uniform(0.01, 0.07);
    surfel.material.emission = glm::dvec3(0.62, 0.66, 0.68) * random.uniform(0.4, 1.1);
    return surfel;
  };
  const auto needle = [](const PartSample& sample, Random& random) {
    Surfel surfel;
    const double away = 14.0 * std::exp(random.uniform(0.0, 2.5)),
                 turn = random.uniform(0.0, 2.0 * M_PI);
    surfel.position =
        at_height(away * std::cos(turn), 0.12 * away * random.uniform(), away * std::sin(turn));
    surfel.axes = frame_about(random.direction(), random);
    const double length = 0.006 * away * thinning(sample, 1000);
    const double ratio = std::exp(random.uniform(std::log(1e3), std::log(1e6)));
    surfel.sigmas = {length, length / ratio, length / ratio};
    surfel.opacity = random.uniform(0.05, 0.35);
    surfel.material.emission = glm::dvec3(0.20, 0.27, 0.14) * random.uniform(0.5, 1.4);
    return surfel;
  };
  const auto invisible = [floater](const PartSample& sample, Random& random) {
    Surfel surfel = floater(sample, random);
    surfel.sigmas *= 4.0;
    surfel.opacity = random.uniform(0.0005, 0.0038);  // below 1/255 = 0.0039
    return surfel;
  };
  return {{0.40 * share, floater}, {0.25 * share, needle}, {0.35 * share, invisible}};
}

BuiltinScene make_outdoor_scene(std::uint64_t count) {
  const Plants plants = planted();
  const Lighting light = afternoon_light(plants);
  std::vector<ScenePart> parts = terrain_parts(0.43);
  const auto add = [&parts](std::vector<ScenePart> more) {
    parts.insert(parts.end(), std::make_move_iterator(more.begin()),
                 std::make_move_iterator(more.end()));
  };
  add(pond_parts(0.045));
  add(plant_parts(plants, 0.265));
  add(building_parts(0.17));
  add(sky_parts(light.sun_direction, 0.07));
  add(artefact_parts(0.02));

  BuiltinScene scene;
  scene.cloud = build_scene(parts, light, count, 2);
  scene.cameras = {standing_at(0, "meadow", 1.5, -9.5, 1.9, at_height(-0.5, 2.4, 10)),
                   standing_at(1, "pond", 1.0, -3.6, 2.1, at_height(8.0, 1.2, 11)),
                   standing_at(2, "house", 0.2, -0.5, 1.9, at_height(-5.4, 1.9, 9)),
                   standing_at(3, "hill", 15.0, -13.0, 8.0, at_height(-1, 0.5, 7)),
                   standing_at(4, "mountains", 5.5, -7.5, 2.2, at_height(-20, 4.5, 12))};
  return scene;
}

BuiltinPath outdoor_walk() {
  struct Stop {
    glm::dvec2 at;  // x, z
    glm::dvec3 target;
  };
  const glm::dvec3 landscape = at_height(-0.5, 2.4, 10);
  const Stop stops[] = {{{1.5, -9.5}, landscape},
                        {{1.4, -6.5}, landscape},
                        {{1.0, -3.6}, at_height(8.0, 1.2, 11)},
                        {{0.2, -0.5}, at_height(-5.4, 1.9, 9)}};
  constexpr int kKeysBetween = 8;
  BuiltinPath path{"walk", {}, false};
  const auto add = [&](const glm::dvec2& at, const glm::dvec3& target) {
    const int key = static_cast<int>(path.keys.size());
    path.keys.push_back(
        standing_at(key, fmt::format("walk_{}", key).c_str(), at.x, at.y, 1.9, target));
  };
  for (std::size_t leg = 0; leg + 1 < std::size(stops); ++leg) {
    const Stop &from = stops[leg], &to = stops[leg + 1];
    for (int i = 0; i < kKeysBetween; ++i) {
      const double t = static_cast<double>(i) / kKeysBetween;
      add(glm::mix(from.at, to.at, t), glm::mix(from.target, to.target, t));
    }
  }
  add(std::end(stops)[-1].at, std::end(stops)[-1].target);
  return path;
}

}  // namespace sgs
