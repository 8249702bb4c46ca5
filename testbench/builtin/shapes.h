// Surfaces as parts of built-in scenes, and maps of them. Heights count upwards although the
// world's y axis points down: a point at height h has y = -h. All maps show their outside.
#pragma once

#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <vector>

#include "testbench/builtin/scene_builder.h"

namespace sgs {

struct SurfacePoint {
  glm::dvec2 uv{0.0};        // 0 to 1 each
  glm::dvec3 position{0.0};  // world
  glm::dvec3 normal{0.0};    // unit, dP/du x dP/dv
};

// A place on the surface for u and v from 0 to 1. Gaussians are spread evenly over (u, v), so the
// mapping sets their density. dP/du x dP/dv must point to the side that is seen.
using SurfaceMap = std::function<glm::dvec3(const glm::dvec2& uv)>;
using MaterialMap = std::function<Material(const SurfacePoint& point)>;

struct PatchLook {
  double flatness = 0.08;     // sigma along the normal over the mean sigma along the surface
  double overlap = 0.66;      // sigma in units of the distance between neighbours
  double opacity_low = 0.80;  // most opacities lie from here to 0.99, some far below
  double sky_visibility = 1.0;
  // Step of a colour within one sigma from which on a Gaussian shrinks away from the edge, as
  // training makes it do. Infinity: texture without edges.
  double edge_contrast = 0.16;
};

constexpr double kNoEdges = std::numeric_limits<double>::infinity();

// Flat Gaussians that cover the surface, sized by the area that falls to each.
ScenePart patch_part(double share, SurfaceMap map, MaterialMap material, PatchLook look = {});

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
