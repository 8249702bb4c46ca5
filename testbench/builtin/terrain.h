// The ground of the built-in scene `outdoor`, and its pond.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "testbench/builtin/scene_builder.h"

namespace sgs {

const glm::dvec3 kUp = glm::dvec3(0.0, -1.0, 0.0);

// Where the pond lies (x, z), its radius and the height of the water.
constexpr double kPondX = 6.5, kPondZ = 2.5, kPondRadius = 3.6, kWaterHeight = -0.42;

// Height of the ground at (x, z); level around the origin, mountains from 150 units on.
double ground_height(double x, double z);

// The point on the ground at (x, z).
glm::dvec3 ground_point(double x, double z);

// Distance of (x, z) from the middle of the path, which winds from the front to the house.
double distance_from_path(double x, double z);

// `colour` as seen through the haze over the distance of `position` from the middle of the scene.
glm::dvec3 hazed(const glm::dvec3& colour, const glm::dvec3& position);

// Ground and grass.
std::vector<ScenePart> terrain_parts(double share);

std::vector<ScenePart> pond_parts(double share);

}  // namespace sgs
