// The formulas of shapes.h.
#include "testbench/builtin/shapes.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

namespace sgs {
namespace {

constexpr double kTurn = 2.0 * M_PI;

}  // namespace

SurfaceMap lathe_map(const glm::dvec3& centre, std::function<glm::dvec2(double v)> profile) {
  return [centre, profile = std::move(profile)](const glm::dvec2& uv) {
    const glm::dvec2 point = profile(uv.y);
    const double angle = kTurn * uv.x;
    return centre + at_height(point.x * std::cos(angle), point.y, point.x * std::sin(angle));
  };
}

SurfaceMap sphere_map(const glm::dvec3& centre, double radius) {
  return lathe_map(centre, [radius](double v) {
    const double height = 2.0 * v - 1.0;
    return radius * glm::dvec2(std::sqrt(std::max(1.0 - height * height, 0.0)), height);
  });
}

SurfaceMap torus_map(const glm::dvec3& centre, const glm::dvec3& axis, double ring_radius,
                     double tube_radius) {
  const glm::dvec3 any = std::abs(axis.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1);
  const glm::dvec3 right = glm::normalize(glm::cross(any, axis)), front = glm::cross(axis, right);
  return [=](const glm::dvec2& uv) {
    const double around = kTurn * uv.x, tube = kTurn * uv.y;
    const glm::dvec3 outward = std::cos(around) * right + std::sin(around) * front;
    return centre + outward * (ring_radius + tube_radius * std::cos(tube)) +
           axis * (tube_radius * std::sin(tube));
  };
}

SurfaceMap plane_map(const glm::dvec3& corner, const glm::dvec3& side_u, const glm::dvec3& side_v) {
  return [=](const glm::dvec2& uv) { return corner + side_u * uv.x + side_v * uv.y; };
}

SurfaceMap disc_map(const glm::dvec3& centre, double radius) {
  return lathe_map(centre, [radius](double v) {
    return glm::dvec2(radius * std::sqrt(std::max(1.0 - v, 0.0)), 0.0);
  });
}

std::vector<SurfaceMap> box_maps(const glm::dvec3& centre, const glm::dvec3& half_x,
                                 const glm::dvec3& half_y, const glm::dvec3& half_z) {
  const auto face = [&centre](const glm::dvec3& out, const glm::dvec3& u, const glm::dvec3& v) {
    return plane_map(centre + out - u - v, 2.0 * u, 2.0 * v);
  };
  return {face(half_x, half_y, half_z), face(-half_x, half_z, half_y),
          face(half_y, half_z, half_x), face(-half_y, half_x, half_z),
          face(half_z, half_x, half_y), face(-half_z, half_y, half_x)};
}

}  // namespace sgs
