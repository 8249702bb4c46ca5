// The light of a built-in scene: sun, sky, simple shadows, and reflections as spherical harmonics.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <vector>

#include "testbench/builtin/surfel.h"

namespace sgs {

// A function of the angle to `axis` as what its SH bands hold: sum over l of
// (2 l + 1) / (4 pi) bands[l] P_l(cos angle).
struct ZonalLobe {
  glm::dvec3 axis{0.0, -1.0, 0.0};  // unit
  std::array<glm::dvec3, 4> bands{};
};

// colour * exp(sharpness (cos angle - 1)), smoothed to degree 3 without ringing.
ZonalLobe spot_lobe(const glm::dvec3& axis, double sharpness, const glm::dvec3& colour);
// mean + slope * cos angle.
ZonalLobe gradient_lobe(const glm::dvec3& axis, const glm::dvec3& mean, const glm::dvec3& slope);

// Something that casts a shadow: a sphere swept along a segment.
struct Capsule {
  glm::dvec3 from{0.0}, to{0.0};
  double radius = 1;
};

struct Lighting {
  glm::dvec3 sun_direction{0.0, -1.0, 0.0};        // unit, towards the sun
  glm::dvec3 sun_colour{1.0};                      // light of a white surface that faces it
  glm::dvec3 sky_colour{0.3}, ground_colour{0.1};  // ambient from above and from below
  double shadow_softness = 0.1;                    // growth of the penumbra per unit of distance
  std::vector<Capsule> occluders;
  std::vector<ZonalLobe> surroundings;  // light that a mirror would show

  // Share of the sun, 0 to 1, that passes the occluders on the way to `point`.
  double sun_visibility(const glm::dvec3& point) const;

  // SH coefficients of degree 3 (3dgs.md, section 2.8, +0.5 taken off) of what is seen of `surfel`.
  // The mirror image of a zonal lobe is a zonal lobe about the mirrored axis, so the reflection of
  // `surroundings` is exact.
  std::array<glm::dvec3, 16> baked(const Surfel& surfel) const;
};

}  // namespace sgs
