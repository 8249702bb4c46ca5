// lighting.h: baked colours against the closed forms, shadows against geometry.
#include "testbench/builtin/lighting.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

#include "algorithm/splat/spherical_harmonics.h"
#include "testbench/builtin/random.h"

using namespace sgs;

namespace {

// What a camera sees that looks along `direction` (unit) at the surfel.
glm::dvec3 seen(const std::array<glm::dvec3, 16>& coeffs, const glm::dvec3& direction) {
  double basis[16];
  sh_basis(3, direction.x, direction.y, direction.z, basis);
  glm::dvec3 colour(0.5);
  for (int k = 0; k < 16; ++k) colour += basis[k] * coeffs[k];
  return colour;
}

Surfel mirror(const glm::dvec3& normal) {
  Surfel surfel;
  surfel.shading_normal = normal;
  surfel.material = {{}, glm::dvec3(0.8, 0.6, 0.4), {}};
  return surfel;
}

}  // namespace

TEST_CASE("lighting: a mirror shows the gradient of the surroundings exactly") {
  Random random(3);
  for (int i = 0; i < 50; ++i) {
    const glm::dvec3 up = random.direction(), normal = random.direction();
    const glm::dvec3 mean(0.3, 0.4, 0.5), slope(0.2, -0.1, 0.3);
    Lighting light;
    light.surroundings = {gradient_lobe(up, mean, slope)};
    const auto coeffs = light.baked(mirror(normal));
    const glm::dvec3 view = random.direction();
    const glm::dvec3 reflected = view - 2.0 * glm::dot(view, normal) * normal;
    const glm::dvec3 expected =
        glm::dvec3(0.8, 0.6, 0.4) * (mean + slope * glm::dot(reflected, up));
    for (int c = 0; c < 3; ++c) CHECK(seen(coeffs, view)[c] == Approx(expected[c]).margin(1e-9));
  }
}

TEST_CASE("lighting: a highlight is brightest where the sun is mirrored, dark opposite") {
  Lighting light;
  const glm::dvec3 sun = glm::normalize(glm::dvec3(1, -2, 0.5)), normal(0, -1, 0);
  light.surroundings = {spot_lobe(sun, 8.0, glm::dvec3(1))};
  const auto coeffs = light.baked(mirror(normal));
  const glm::dvec3 best = sun - 2.0 * glm::dot(sun, normal) * normal;
  const double peak = seen(coeffs, best).x;
  CHECK(peak > 0.5 * 0.8);
  CHECK(peak < 1.0 * 0.8);
  Random random(4);
  for (int i = 0; i < 200; ++i) {
    const glm::dvec3 view = random.direction();
    CHECK(seen(coeffs, view).x <= peak + 1e-12);
    if (glm::dot(view, best) < 0) CHECK(std::abs(seen(coeffs, view).x) < 0.08);
  }
}

TEST_CASE("lighting: matte surfaces look the same from everywhere, by Lambert's law") {
  Lighting light;
  light.sun_direction = {0, -1, 0};
  light.sun_colour = glm::dvec3(0.6);
  light.sky_colour = glm::dvec3(0.4);
  light.ground_colour = glm::dvec3(0.1);
  Surfel surfel;
  surfel.material.albedo = {1.0, 0.5, 0.25};
  const auto brightness = [&](const glm::dvec3& normal) {
    surfel.shading_normal = glm::normalize(normal);
    return seen(light.baked(surfel), glm::normalize(glm::dvec3(1, 2, 3)));
  };
  CHECK(brightness({0, -1, 0}).x == Approx(0.4 + 0.6));
  CHECK(brightness({0, -1, 0}).z == Approx(0.25 * (0.4 + 0.6)));
  CHECK(brightness({1, -1, 0}).x == Approx(0.4 * 0.853553 + 0.1 * 0.146447 + 0.6 * 0.707107));
  CHECK(brightness({0, 1, 0}).x == Approx(0.1));
}

TEST_CASE("lighting: a ball keeps the sun from what is behind it") {
  Lighting light;
  light.sun_direction = {0, -1, 0};
  light.shadow_softness = 0.1;
  light.occluders = {{{0, -5, 0}, {0, -5, 0}, 1.0}};
  CHECK(light.sun_visibility({0, 0, 0}) == 0.0);
  // 5 below the ball's centre the penumbra is 0.5 + 0.02 to each side of the edge at 1.
  CHECK(light.sun_visibility({0.47, 0, 0}) == 0.0);
  CHECK(light.sun_visibility({1.0, 0, 0}) == Approx(0.5).margin(0.02));
  CHECK(light.sun_visibility({1.53, 0, 0}) == 1.0);
  CHECK(light.sun_visibility({0, -7, 0}) == 1.0);  // between the ball and the sun
  CHECK(light.sun_visibility({0, -5, 0}) == 0.0);  // inside
}

TEST_CASE("lighting: a capsule shades like the swept ball, however large") {
  for (const double scale : {1.0, 200.0}) {
    CAPTURE(scale);
    Lighting light;
    light.sun_direction = {0, -1, 0};
    light.shadow_softness = 0.0;
    light.occluders = {{scale * glm::dvec3(-3, -5, 0), scale * glm::dvec3(3, -5, 0), 0.5 * scale}};
    const auto visibility = [&](double x, double y, double z) {
      return light.sun_visibility(scale * glm::dvec3(x, y, z));
    };
    for (const double x : {-3.3, -2.0, 0.0, 3.3}) CHECK(visibility(x, 0, 0) == 0.0);
    for (const double x : {-3.6, 3.6}) CHECK(visibility(x, 0, 0) == 1.0);
    CHECK(visibility(1, 0, 0.6) == 1.0);
    CHECK(visibility(1, 0, 0.4) == 0.0);
    // The edge is as wide as a fiftieth of the radius to each side: 9 tenths of it, by smoothstep.
    CHECK(visibility(3.508, 0, 0) == Approx(0.972));
    CHECK(visibility(1, 0, 0.508) == Approx(0.972));
    // The sun along the capsule's axis.
    light.sun_direction = {1, 0, 0};
    CHECK(visibility(-9, -5, 0.3) == 0.0);
    CHECK(visibility(-9, -5, 0.6) == 1.0);
  }
}
