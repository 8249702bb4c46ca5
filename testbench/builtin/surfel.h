// A flat Gaussian on a surface before its colours are baked.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace sgs {

struct Material {
  glm::dvec3 albedo{0.5};       // 0 to 1, diffuse
  glm::dvec3 reflectance{0.0};  // 0 to 1, mirror-like: what of the surroundings comes back
  glm::dvec3 emission{0.0};     // colour whatever the light, such as sky
};

struct Surfel {
  glm::dvec3 position{0.0};  // world; y points down
  glm::dmat3 axes{1.0};      // columns: two tangents and the normal, orthonormal, right-handed
  glm::dvec3 sigmas{1.0};    // standard deviations along the axes, world units
  glm::dvec3 shading_normal{0.0, -1.0, 0.0};  // unit; differs from the third axis in foliage
  double opacity = 0.95;                      // 0 to 1, both exclusive
  double sky_visibility = 1.0;                // 0 to 1: ambient light that reaches the place
  Material material;
};

}  // namespace sgs
