// Gaussians on surfaces.
#include "testbench/builtin/shapes.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/matrix.hpp>
#include <utility>

namespace sgs {

namespace {

constexpr double kEdge = 1e-3;        // keeps off the ends, where surfaces close to points
constexpr double kDifference = 1e-4;  // step of u and v for derivatives
constexpr double kMaxAspect = 2.5;    // longer ones would smear the texture

// The surface near one point, to first order.
struct LocalFrame {
  glm::dvec3 first{0.0}, second{0.0}, normal{0.0};  // orthonormal, right-handed
  glm::dmat2 surface_from_uv{1.0};                  // to coordinates along first and second
};

LocalFrame local_frame(const SurfaceMap& map, const glm::dvec2& uv) {
  const glm::dvec2 step_u(kDifference, 0.0), step_v(0.0, kDifference);
  const glm::dvec3 du = (map(uv + step_u) - map(uv - step_u)) / (2.0 * kDifference);
  const glm::dvec3 dv = (map(uv + step_v) - map(uv - step_v)) / (2.0 * kDifference);
  LocalFrame frame;
  frame.normal = glm::normalize(glm::cross(du, dv));
  frame.first = glm::normalize(glm::dot(du, du) > glm::dot(dv, dv) ? du : dv);
  frame.second = glm::cross(frame.normal, frame.first);
  frame.surface_from_uv = {{glm::dot(du, frame.first), glm::dot(du, frame.second)},
                           {glm::dot(dv, frame.first), glm::dot(dv, frame.second)}};
  return frame;
}

// Axes and standard deviations along the surface of the covariance (du du^T + dv dv^T) * cell,
// which carries the even grid of (u, v) to the surface.
void fit_ellipse(const LocalFrame& frame, double cell, Surfel& surfel) {
  const glm::dmat2 covariance = frame.surface_from_uv * glm::transpose(frame.surface_from_uv);
  const double aa = covariance[0][0], ab = covariance[0][1], bb = covariance[1][1];
  const double angle = 0.5 * std::atan2(2.0 * ab, aa - bb);
  const double middle = 0.5 * (aa + bb), half = std::hypot(0.5 * (aa - bb), ab);
  const double area = std::sqrt(std::max(aa * bb - ab * ab, 1e-30));
  // The area of the cell stays where the aspect is limited, so the cover does too.
  const double aspect =
      std::min(std::sqrt((middle + half) / std::max(middle - half, 1e-30)), kMaxAspect);
  const glm::dvec3 along = std::cos(angle) * frame.first + std::sin(angle) * frame.second;
  surfel.axes = glm::dmat3(along, glm::cross(frame.normal, along), frame.normal);
  surfel.sigmas = {std::sqrt(area * aspect * cell), std::sqrt(area / aspect * cell), 0.0};
}

double contrast(const Material& a, const Material& b) {
  const glm::dvec3 difference = glm::abs(a.albedo - b.albedo) +
                                glm::abs(a.reflectance - b.reflectance) +
                                glm::abs(a.emission - b.emission);
  return std::max({difference.x, difference.y, difference.z});
}

// Pulls the Gaussian in from sides where the material changes.
void avoid_edges(const SurfacePoint& point, const LocalFrame& frame, const MaterialMap& material,
                 double edge_contrast, Surfel& surfel) {
  const glm::dmat2 uv_from_surface = glm::inverse(frame.surface_from_uv);
  for (int axis = 0; axis < 2; ++axis) {
    const double sigma = surfel.sigmas[axis];
    for (const double side : {1.0, -1.0}) {
      const glm::dvec3 away = side * sigma * surfel.axes[axis];
      SurfacePoint beside = point;
      beside.position += away;
      beside.uv +=
          uv_from_surface * glm::dvec2(glm::dot(away, frame.first), glm::dot(away, frame.second));
      if (contrast(material(beside), surfel.material) < edge_contrast) continue;
      surfel.sigmas[axis] *= 0.6;
      surfel.position -= 0.35 * away;
    }
  }
}

// Mostly near-opaque with a tail of faint ones, as training leaves them.
double trained_opacity(double low, Random& random) {
  const double pick = random.uniform();
  if (pick < 0.82) return random.uniform(low, 0.99);
  if (pick < 0.94) return random.uniform(0.5 * low, low);
  return random.uniform(0.05, 0.5 * low);
}

constexpr double kTurn = 2.0 * M_PI;

}  // namespace

ScenePart patch_part(double share, SurfaceMap map, MaterialMap material, PatchLook look) {
  return {share, [map = std::move(map), material = std::move(material), look](
                     const PartSample& sample, Random& random) {
            const glm::dvec2 uv = kEdge + (1.0 - 2.0 * kEdge) * even_point(sample.index);
            const LocalFrame frame = local_frame(map, uv);
            const SurfacePoint point{uv, map(uv), frame.normal};
            Surfel surfel;
            surfel.position = point.position;
            surfel.shading_normal = frame.normal;
            surfel.opacity = trained_opacity(look.opacity_low, random);
            surfel.sky_visibility = look.sky_visibility;
            surfel.material = material(point);
            fit_ellipse(frame, 1.0 / static_cast<double>(sample.count), surfel);
            surfel.sigmas *= look.overlap * random.uniform(0.85, 1.2);
            surfel.sigmas.z = look.flatness * std::sqrt(surfel.sigmas.x * surfel.sigmas.y);
            avoid_edges(point, frame, material, look.edge_contrast, surfel);
            return surfel;
          }};
}

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
