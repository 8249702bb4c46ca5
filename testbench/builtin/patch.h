// A parametric surface as a part of a built-in scene.
#pragma once

#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>

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

}  // namespace sgs
