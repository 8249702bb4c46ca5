// Light and cameras of outdoor_scene.h.
#include "testbench/builtin/outdoor_scene.h"

#include <fmt/format.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <iterator>
#include <utility>
#include <vector>

#include "testbench/builtin/buildings.h"
#include "testbench/builtin/camera_rig.h"
#include "testbench/builtin/lighting.h"
#include "testbench/builtin/plants.h"
#include "testbench/builtin/pond.h"
#include "testbench/builtin/scene_builder.h"
#include "testbench/builtin/shapes.h"
#include "testbench/builtin/sky.h"
#include "testbench/builtin/terrain.h"

namespace sgs {
namespace {

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
