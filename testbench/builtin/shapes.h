// Surfaces for the parts of built-in scenes. Heights count upwards although the world's y axis
// points down: a point at height h has y = -h. All of them show their outside (patch.h).
#pragma once

#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "testbench/builtin/patch.h"

namespace sgs {

// The world's point at horizontal position (x, z) and height h.
inline glm::dvec3 at_height(double x, double h, double z) { return {x, -h, z}; }

// Turns the profile (radius, height) about the vertical axis through `centre`; u is the angle, v
// the way along the profile, which must run upwards on its outer side.
SurfaceMap lathe_map(const glm::dvec3& centre, std::function<glm::dvec2(double v)> profile);

// Ball around `centre`, evenly by area: u the angle, v the height.
SurfaceMap sphere_map(const glm::dvec3& centre, double radius);

// Ring around the line through `centre` along `axis` (unit).
SurfaceMap torus_map(const glm::dvec3& centre, const glm::dvec3& axis, double ring_radius,
                     double tube_radius);

// The parallelogram corner + u side_u + v side_v, seen from the side of side_u x side_v.
SurfaceMap plane_map(const glm::dvec3& corner, const glm::dvec3& side_u, const glm::dvec3& side_v);

// Level disc of `radius` at the height of `centre`, seen from above; u the angle, v the squared
// distance, so evenly by area.
SurfaceMap disc_map(const glm::dvec3& centre, double radius);

// A box around `centre` with half sides along three right-handed orthogonal vectors `half_x`,
// `half_y` (down), `half_z`: the maps of its six faces.
std::vector<SurfaceMap> box_maps(const glm::dvec3& centre, const glm::dvec3& half_x,
                                 const glm::dvec3& half_y, const glm::dvec3& half_z);

}  // namespace sgs
