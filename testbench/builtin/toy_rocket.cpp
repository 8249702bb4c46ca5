// Shape and paint of toy_rocket.h.
#include "testbench/builtin/toy_rocket.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "testbench/builtin/random.h"
#include "testbench/builtin/shapes.h"

namespace sgs {
namespace {

constexpr double kBase = 0.38, kLength = 2.12;  // heights of the hull's lower end and its length
const glm::dvec3 kRed(0.80, 0.07, 0.05), kWhite(0.92, 0.91, 0.87), kSteel(0.30, 0.31, 0.33);
const glm::dvec3 kPaintGloss(0.10), kChrome(0.62, 0.64, 0.67);

// (radius, height) along the hull, t from the nozzle's seat to the tip.
glm::dvec2 hull_profile(double t) {
  const double swell = std::sin(M_PI * (0.16 + 0.84 * t));
  return {0.47 * std::pow(std::max(swell, 0.0), 0.85), kBase + kLength * t};
}

Material hull_paint(const SurfacePoint& point) {
  const double t = point.uv.y;
  const bool even = (static_cast<int>(std::floor(point.uv.x * 8.0)) +
                     static_cast<int>(std::floor((t - 0.12) / 0.11))) %
                        2 ==
                    0;
  if (t > 0.735 && t < 0.765) return {kSteel, kChrome, {}};
  if (t > 0.75) return {kRed, kPaintGloss, {}};
  if (t > 0.45) return {kWhite, kPaintGloss, {}};
  if (t > 0.12) return {even ? kRed : kWhite, kPaintGloss, {}};
  return {kRed, kPaintGloss, {}};
}

// Side `side` (+1 or -1) of the fin at `angle`: a blade, thick at the hull, swept out to the table.
SurfaceMap fin_map(double angle, double side) {
  const glm::dvec3 out(std::cos(angle), 0.0, std::sin(angle));
  const glm::dvec3 across(-out.z, 0.0, out.x);
  return [=](const glm::dvec2& uv) {
    // u from the hull outwards, v from the top of the fin down; mirrored for the other side.
    const double u = uv.x, v = side > 0 ? uv.y : 1.0 - uv.y;
    const double root_t = 0.30 * (1.0 - v) + 0.02 * v;
    const glm::dvec2 root = hull_profile(root_t) * glm::dvec2(0.96, 1.0);
    const double sweep = std::pow(v, 1.4);
    const glm::dvec2 edge(0.46 + 0.46 * std::sin(0.5 * M_PI * sweep), 1.12 - 1.12 * v);
    const glm::dvec2 at = glm::mix(root, edge, u);
    const double thickness =
        0.05 * std::sqrt(std::max(1.0 - u * u, 0.0)) * std::pow(std::sin(M_PI * v) + 0.02, 0.4);
    return at_height(0, at.y, 0) + out * at.x + across * (side * thickness);
  };
}

void add_porthole(double angle, double share, std::vector<ScenePart>& parts) {
  constexpr double kAt = 0.595, kRadius = 0.15;
  const glm::dvec2 at = hull_profile(kAt), above = hull_profile(kAt + 0.01);
  const glm::dvec3 out(std::cos(angle), 0.0, std::sin(angle));
  // Normal of the hull there: the outward direction tilted by the slope of the profile.
  const double slope = (above.x - at.x) / (above.y - at.y);
  const glm::dvec3 normal = glm::normalize(out + at_height(0, -slope, 0));
  const glm::dvec3 centre = at_height(0, at.y, 0) + out * at.x;
  parts.push_back(patch_part(0.6 * share,
                             torus_map(centre - normal * 0.005, normal, kRadius, 0.032),
                             [](const SurfacePoint&) {
                               return Material{kSteel, kChrome, {}};
                             }));
  const glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3(0, 1, 0), normal));
  const glm::dvec3 down = glm::cross(normal, right);
  const SurfaceMap glass = [=](const glm::dvec2& uv) {
    const double radius = kRadius * std::sqrt(1.0 - uv.y), around = 2.0 * M_PI * uv.x;
    const double bulge = 0.05 * (1.0 - radius * radius / (kRadius * kRadius));
    return centre + normal * (0.015 + bulge) +
           radius * (std::cos(around) * right + std::sin(around) * down);
  };
  parts.push_back(patch_part(0.4 * share, glass, [](const SurfacePoint&) {
    return Material{{0.03, 0.09, 0.17}, {0.38, 0.46, 0.52}, {}};
  }));
}

}  // namespace

std::vector<ScenePart> toy_rocket_parts(double share) {
  std::vector<ScenePart> parts = {
      patch_part(0.56 * share, lathe_map(glm::dvec3(0), [](double t) { return hull_profile(t); }),
                 hull_paint)};
  for (int fin = 0; fin < 3; ++fin) {
    const double angle = 2.0 * M_PI * (fin / 3.0 + 0.09);
    for (const double side : {1.0, -1.0}) {
      parts.push_back(patch_part(0.045 * share, fin_map(angle, side), [](const SurfacePoint& p) {
        const bool tip = p.uv.x > 0.86;
        return Material{tip ? kWhite : kRed, kPaintGloss, {}};
      }));
    }
    const glm::dvec3 foot = at_height(0.90 * std::cos(angle), 0.065, 0.90 * std::sin(angle));
    parts.push_back(patch_part(0.012 * share, sphere_map(foot, 0.065), [](const SurfacePoint&) {
      return Material{kSteel, kChrome, {}};
    }));
    add_porthole(angle + M_PI / 3.0, 0.03 * share, parts);
  }
  const auto nozzle = [](double t) {
    return glm::dvec2(0.30 - 0.10 * std::pow(t, 0.6), 0.16 + 0.25 * t);
  };
  parts.push_back(patch_part(0.04 * share, lathe_map(glm::dvec3(0), nozzle),
                             [](const SurfacePoint& p) {
                               const double rib = 0.5 + 0.5 * std::cos(40.0 * p.uv.y);
                               return Material{kSteel * (0.3 + 0.5 * rib), kChrome * 0.5, {}};
                             },
                             {0.08, 0.62, 0.8, 0.6}));
  return parts;
}

std::vector<Capsule> toy_rocket_occluders() {
  std::vector<Capsule> capsules;
  const auto add = [&capsules](double low, double high, double radius) {
    capsules.push_back({at_height(0, low, 0), at_height(0, high, 0), radius});
  };
  // Thinner than the hull, which would otherwise lie in its own shadow.
  add(0.85, 1.60, 0.40);
  add(0.50, 1.85, 0.26);
  add(0.30, 2.20, 0.10);
  for (int fin = 0; fin < 3; ++fin) {
    const double angle = 2.0 * M_PI * (fin / 3.0 + 0.09);
    const glm::dvec3 out(std::cos(angle), 0.0, std::sin(angle));
    capsules.push_back(
        {at_height(0, 0.80, 0) + out * 0.45, at_height(0, 0.1, 0) + out * 0.84, 0.035});
    capsules.push_back(
        {at_height(0, 0.60, 0) + out * 0.40, at_height(0, 0.35, 0) + out * 0.60, 0.035});
  }
  return capsules;
}

}  // namespace sgs
