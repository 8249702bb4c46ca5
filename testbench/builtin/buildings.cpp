// Walls and roofs of buildings.h.
#include "testbench/builtin/buildings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>

#include "testbench/builtin/random.h"
#include "testbench/builtin/shapes.h"
#include "testbench/builtin/terrain.h"

namespace sgs {
namespace {

const glm::dvec3 kHouse = at_height(-6.0, 0.0, 9.0), kTower = at_height(9.0, 0.0, 16.0);
constexpr double kHouseTurn = 0.30;  // radians about the vertical
constexpr double kHalfLength = 3.1, kHalfDepth = 2.2, kWallHeight = 2.6, kGable = 1.9;
constexpr double kTowerRadius = 1.7, kTowerHeight = 7.5;

glm::dvec3 house_axis_x() { return {std::cos(kHouseTurn), 0.0, std::sin(kHouseTurn)}; }
glm::dvec3 house_axis_z() { return {-std::sin(kHouseTurn), 0.0, std::cos(kHouseTurn)}; }

// (a, b) in metres on a wall `width` wide, from its lower left corner.
Material wall_paint(double a, double b, double width, bool has_door) {
  const double grain = fractal_noise({a * 4.0, b * 4.0, width}, 3);
  const glm::dvec3 plaster = glm::dvec3(0.88, 0.82, 0.70) * (0.85 + 0.3 * grain);
  const glm::dvec3 beam = glm::dvec3(0.26, 0.16, 0.09) * (0.7 + 0.6 * grain);
  if (b < 0.35) return {glm::dvec3(0.42, 0.40, 0.38) * (0.5 + grain), {}, {}};
  const double middle = std::abs(a - 0.5 * width);
  if (has_door && middle < 0.5 && b < 1.95) {
    const bool frame = middle > 0.40 || b > 1.85;
    return {
        frame ? beam : glm::dvec3(0.14, 0.30, 0.24) * (0.8 + 0.4 * grain), glm::dvec3(0.04), {}};
  }
  for (const double window : {0.22 * width, 0.78 * width}) {
    const double x = std::abs(a - window), y = std::abs(b - 1.45);
    if (x > 0.52 || y > 0.55) continue;
    const bool frame = x > 0.42 || y > 0.45 || x < 0.04 || y < 0.04;
    if (frame) return {glm::dvec3(0.93, 0.93, 0.90), glm::dvec3(0.03), {}};
    return {{0.04, 0.06, 0.08}, {0.42, 0.45, 0.48}, {}};
  }
  const bool upright = std::min({a, width - a}) < 0.14 || std::abs(middle - 0.17 * width) < 0.07;
  const bool level = std::abs(b - 2.5) < 0.10 || std::abs(b - 0.42) < 0.08;
  return {upright || level ? beam : plaster, {}, {}};
}

Material roof_paint(const SurfacePoint& p) {
  const double row = 11.0 * p.uv.y - std::floor(11.0 * p.uv.y);
  const double tint = fractal_noise(p.position * 3.1, 3);
  return {glm::dvec3(0.52, 0.20, 0.12) * ((0.45 + 0.55 * row) * (0.6 + 0.8 * tint)),
          glm::dvec3(0.08),
          {}};
}

void add_box(const glm::dvec3& centre, const glm::dvec3& half_x, double half_height,
             const glm::dvec3& half_z, const MaterialMap& paint, double share,
             std::vector<ScenePart>& parts) {
  for (SurfaceMap& map : box_maps(centre, half_x, glm::dvec3(0.0, half_height, 0.0), half_z)) {
    parts.push_back(patch_part(share / 6.0, std::move(map), paint));
  }
}

void add_house(double share, std::vector<ScenePart>& parts) {
  const glm::dvec3 x = house_axis_x(), z = house_axis_z();
  const auto wall = [&](const glm::dvec3& out, const glm::dvec3& right, double half_width,
                        double gable, bool has_door, double part) {
    const glm::dvec3 corner = kHouse + out - right * half_width;
    const SurfaceMap map = [=](const glm::dvec2& uv) {
      const double top = kWallHeight + gable * (1.0 - std::abs(2.0 * uv.x - 1.0));
      return corner + right * (2.0 * half_width * uv.x) + kUp * (top * uv.y);
    };
    parts.push_back(patch_part(part * share, map, [=](const SurfacePoint& p) {
      return wall_paint(2.0 * half_width * p.uv.x, -p.position.y, 2.0 * half_width, has_door);
    }));
  };
  wall(-z * kHalfDepth, x, kHalfLength, 0.0, true, 0.24);
  wall(z * kHalfDepth, -x, kHalfLength, 0.0, false, 0.08);
  wall(x * kHalfLength, z, kHalfDepth, kGable, false, 0.18);
  wall(-x * kHalfLength, -z, kHalfDepth, kGable, false, 0.10);

  // Each half of the roof from the eaves, which overhang, to the ridge.
  const glm::dvec3 ridge = kHouse + kUp * (kWallHeight + kGable + 0.06);
  for (const double side : {-1.0, 1.0}) {
    const glm::dvec3 right = -side * x;
    const glm::dvec3 eaves = kHouse + kUp * (kWallHeight - 0.35) + z * (side * (kHalfDepth + 0.42));
    const double half = kHalfLength + 0.35;
    parts.push_back(patch_part(side < 0 ? 0.22 * share : 0.10 * share,
                               plane_map(eaves - right * half, right * (2.0 * half), ridge - eaves),
                               roof_paint, {0.12, 0.66, 0.85, 1.0, kNoEdges}));
  }
  add_box(
      kHouse + x * 1.7 + z * 0.6 + kUp * 4.3, x * 0.32, 0.75, z * 0.32,
      [](const SurfacePoint& p) {
        const double brick = fractal_noise(p.position * 7.0, 2);
        return Material{glm::dvec3(0.45, 0.24, 0.18) * (0.5 + brick), {}, {}};
      },
      0.08 * share, parts);
}

Material tower_paint(const SurfacePoint& p) {
  const double row = std::floor(p.uv.y * 24.0);
  const double shift = 0.5 * (static_cast<int>(row) % 2);
  const double across = p.uv.x * 18.0 + shift, up = p.uv.y * 24.0;
  const double joint = std::min(across - std::floor(across), up - row);
  const double tint = value_noise({std::floor(across) * 3.7, row * 5.1, 0.0});
  const double grain = fractal_noise(p.position * 4.0, 3);
  glm::dvec3 stone = glm::mix(glm::dvec3(0.50, 0.47, 0.43), glm::dvec3(0.66, 0.60, 0.52), tint);
  if (joint < 0.12) stone *= 0.6;
  const double turn = p.uv.x * 6.0 - std::floor(p.uv.x * 6.0);
  const double level = std::abs(p.uv.y - 0.45), higher = std::abs(p.uv.y - 0.82);
  if (std::abs(turn - 0.5) < 0.09 && std::min(level, higher) < 0.05)
    return {{0.05, 0.05, 0.06}, {}, {}};
  return {stone * (0.6 + 0.8 * grain), {}, {}};
}

void add_tower(double share, std::vector<ScenePart>& parts) {
  const auto wall = [](double v) {
    const double flare = 0.28 * smooth_step(0.86, 0.92, v) + 0.25 * std::exp(-9.0 * v);
    return glm::dvec2(kTowerRadius + flare, kTowerHeight * v - 0.3);
  };
  parts.push_back(patch_part(0.62 * share, lathe_map(kTower, wall), tower_paint));
  const auto cone = [](double v) {
    const double along = 1.0 - std::sqrt(1.0 - v);  // evenly by area
    return glm::dvec2((kTowerRadius + 0.75) * (1.0 - along), kTowerHeight - 0.45 + 3.6 * along);
  };
  parts.push_back(patch_part(0.33 * share, lathe_map(kTower, cone), [](const SurfacePoint& p) {
    const double tint = fractal_noise(p.position * 2.6, 3);
    return Material{glm::dvec3(0.20, 0.27, 0.36) * (0.5 + tint), glm::dvec3(0.10), {}};
  }));
  const glm::dvec3 tip = kTower + kUp * (kTowerHeight + 3.0);
  const SurfaceMap flag = [tip](const glm::dvec2& uv) {
    const double wave = 0.12 * uv.x * std::sin(7.0 * uv.x);
    return tip + kUp * (1.2 - 0.55 * uv.y) + glm::dvec3(-1.15 * uv.x, 0.05 * uv.x, wave);
  };
  parts.push_back(patch_part(0.04 * share, flag, [](const SurfacePoint& p) {
    const bool stripe = p.uv.y > 0.36 && p.uv.y < 0.66;
    return Material{stripe ? glm::dvec3(0.95, 0.92, 0.85) : glm::dvec3(0.75, 0.10, 0.10), {}, {}};
  }));
  add_box(
      tip + kUp * 0.6, glm::dvec3(0.03, 0, 0), 0.65, glm::dvec3(0, 0, 0.03),
      [](const SurfacePoint&) {
        return Material{glm::dvec3(0.2), {}, {}};
      },
      0.01 * share, parts);
}

void add_fence(double share, std::vector<ScenePart>& parts) {
  constexpr int kPosts = 14;
  const auto wood = [](const SurfacePoint& p) {
    const double grain = fractal_noise(p.position * glm::dvec3(9.0, 3.0, 9.0), 2);
    return Material{glm::dvec3(0.55, 0.45, 0.33) * (0.5 + grain), {}, {}};
  };
  const auto post = [](int i) { return ground_point(-8.6 + 0.25 * i * 0.3, 4.6 - 1.25 * i); };
  for (int i = 0; i < kPosts; ++i) {
    const glm::dvec3 here = post(i), next = post(i + 1);
    add_box(here + kUp * 0.45, glm::dvec3(0.055, 0, 0), 0.5, glm::dvec3(0, 0, 0.055), wood,
            0.5 * share / kPosts, parts);
    const glm::dvec3 along = 0.5 * (next - here);
    const glm::dvec3 side = 0.025 * glm::normalize(glm::cross(along, kUp));
    for (const double height : {0.38, 0.76}) {
      const glm::dvec3 rail = 0.5 * (here + next) + kUp * height;
      add_box(rail, along, 0.05, -side, wood, 0.25 * share / kPosts, parts);
    }
  }
}

constexpr int kPoles = 6;

glm::dvec3 pole_foot(int i) { return ground_point(-17.5 + 0.9 * i, -30.0 + 11.0 * i); }

// The wires: needles a million times longer than thick, as training makes of thin lines.
Surfel wire(const PartSample& sample, Random& random) {
  const double t = even_point(sample.index).x * (kPoles - 1);
  const int span = std::min(static_cast<int>(t), kPoles - 2);
  const double across = static_cast<double>(sample.index % 3) - 1.0;
  const auto point = [&](double s) {
    const glm::dvec3 from = pole_foot(span), to = pole_foot(span + 1);
    const double sag = 0.9 * 4.0 * s * (1.0 - s);
    return glm::mix(from, to, s) + kUp * (6.3 - sag) + glm::dvec3(0.55 * across, 0.0, 0.0);
  };
  const double s = t - span;
  const glm::dvec3 along = glm::normalize(point(s + 0.01) - point(s - 0.01));
  const glm::dvec3 side = glm::normalize(glm::cross(along, kUp));
  Surfel surfel;
  surfel.position = point(s);
  surfel.axes = glm::dmat3(along, side, glm::cross(along, side));
  const double length =
      std::min(2.0, 3.0 * 11.0 * (kPoles - 1) / static_cast<double>(sample.count));
  surfel.sigmas = {length, 1e-6 * length, 0.7e-6 * length};
  surfel.opacity = random.uniform(0.5, 0.95);
  surfel.material.albedo = glm::dvec3(0.08);
  return surfel;
}

void add_power_line(double share, std::vector<ScenePart>& parts) {
  const auto wood = [](const SurfacePoint& p) {
    return Material{
        glm::dvec3(0.34, 0.27, 0.20) * (0.6 + 0.8 * fractal_noise(p.position * 5.0, 2)), {}, {}};
  };
  for (int i = 0; i < kPoles; ++i) {
    const glm::dvec3 foot = pole_foot(i);
    const auto profile = [](double v) { return glm::dvec2(0.13 - 0.04 * v, 6.7 * v - 0.2); };
    parts.push_back(patch_part(0.5 * share / kPoles, lathe_map(foot, profile), wood));
    add_box(foot + kUp * 6.1, glm::dvec3(0.75, 0, 0), 0.06, glm::dvec3(0, 0, 0.06), wood,
            0.2 * share / kPoles, parts);
  }
  parts.push_back({0.3 * share, wire});
}

}  // namespace

std::vector<ScenePart> building_parts(double share) {
  std::vector<ScenePart> parts;
  add_house(0.46 * share, parts);
  add_tower(0.30 * share, parts);
  add_fence(0.14 * share, parts);
  add_power_line(0.10 * share, parts);
  return parts;
}

std::vector<Capsule> building_occluders() {
  const glm::dvec3 along = house_axis_x();
  const auto level = [&along](double height, double half, double radius) {
    const glm::dvec3 middle = kHouse + kUp * height;
    return Capsule{middle - along * half, middle + along * half, radius};
  };
  // Inside the walls, or these would lie in their own shadow.
  return {level(1.0, 1.5, 1.6),
          level(2.2, 1.8, 1.3),
          level(3.3, 2.9, 0.75),
          {kTower, kTower + kUp * (kTowerHeight - 0.8), 0.88 * kTowerRadius},
          {kTower, kTower + kUp * (kTowerHeight + 1.4), 0.8}};
}

}  // namespace sgs
