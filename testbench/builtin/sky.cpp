// Clouds and leftovers of sky.h.
#include "testbench/builtin/sky.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "testbench/builtin/noise.h"
#include "testbench/builtin/shapes.h"

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

}  // namespace sgs
