// Turns parts of a built-in scene into a cloud of a given size.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "algorithm/scene/gaussian_cloud.h"
#include "testbench/builtin/random.h"

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

// Which Gaussian of a part is wanted.
struct PartSample {
  std::uint64_t index = 0;  // 0 .. count - 1
  std::uint64_t count = 1;  // Gaussians that the part gets
};

// Factor on the size of loose Gaussians, such as blades of grass: 1 up to `usual` of them, then
// less so that more of them do not cover more.
inline double thinning(const PartSample& sample, double usual) {
  return std::min(1.0, std::sqrt(usual / static_cast<double>(sample.count)));
}

// A part makes each of its Gaussians from its index and a random stream of its own.
struct ScenePart {
  double share = 1;  // its part of the scene's Gaussians, relative to the other parts
  std::function<Surfel(const PartSample&, Random&)> surfel;
};

// Makes `count` Gaussians of SH degree 3, dealt out to `parts` by share, in an order without
// pattern, as training leaves them. Runs on all threads; the result does not depend on their
// number.
GaussianCloud build_scene(const std::vector<ScenePart>& parts, const Lighting& lighting,
                          std::uint64_t count, std::uint64_t seed);

}  // namespace sgs
