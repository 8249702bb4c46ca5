// Table, toys, room and cameras of object_scene.h.
#include "testbench/builtin/object_scene.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "testbench/builtin/builtin_scene.h"
#include "testbench/builtin/random.h"
#include "testbench/builtin/scene_builder.h"
#include "testbench/builtin/shapes.h"
#include "testbench/builtin/toy_rocket.h"

namespace sgs {
namespace {

constexpr double kTableRadius = 2.6, kRoomRadius = 7.5;
const glm::dvec3 kChromeCentre = at_height(1.15, 0.40, -0.75);
constexpr double kChromeRadius = 0.40;
const glm::dvec3 kMarbleCentre = at_height(0.85, 0.24, -1.55);
constexpr double kMarbleRadius = 0.24;
const glm::dvec3 kRingCentre = at_height(-0.35, 0.12, -1.50);

Lighting studio_light() {
  Lighting light;
  light.sun_direction = glm::normalize(at_height(-0.62, 1.0, -0.55));
  light.sun_colour = {0.78, 0.74, 0.68};
  light.sky_colour = {0.42, 0.44, 0.48};
  light.ground_colour = {0.22, 0.20, 0.18};
  light.shadow_softness = 0.16;
  const glm::dvec3 up = at_height(0, 1, 0);
  light.surroundings = {
      gradient_lobe(up, glm::dvec3(0.34, 0.35, 0.37), glm::dvec3(0.22, 0.24, 0.28)),
      spot_lobe(light.sun_direction, 9.0, glm::dvec3(2.6, 2.5, 2.3)),
      spot_lobe(glm::normalize(at_height(0.9, 0.4, 0.3)), 7.0, glm::dvec3(0.5, 0.6, 0.8))};
  light.occluders = toy_rocket_occluders();
  light.occluders.push_back({kChromeCentre, kChromeCentre, kChromeRadius * 0.97});
  for (int i = 0; i < 8; ++i) {
    const double from = 2.0 * M_PI * i / 8, to = 2.0 * M_PI * (i + 1) / 8;
    light.occluders.push_back({kRingCentre + 0.30 * glm::dvec3(std::cos(from), 0, std::sin(from)),
                               kRingCentre + 0.30 * glm::dvec3(std::cos(to), 0, std::sin(to)),
                               0.1});
  }
  return light;
}

// Light that the toys keep from the table close to where they stand.
double table_openness(const glm::dvec3& position) {
  const auto dent = [&position](const glm::dvec3& centre, double radius, double depth) {
    const double away = std::hypot(position.x - centre.x, position.z - centre.z);
    return 1.0 - depth * std::exp(-away * away / (radius * radius));
  };
  return dent(glm::dvec3(0), 0.75, 0.55) * dent(kChromeCentre, 0.36, 0.7) *
         dent(kMarbleCentre, 0.22, 0.5) * dent(kRingCentre, 0.45, 0.45) *
         dent(at_height(-1.25, 0, -0.55), 0.42, 0.5) * dent(at_height(-1.05, 0, 0.85), 0.4, 0.5);
}

Material table_top(const SurfacePoint& point) {
  constexpr double kSquare = 0.4;
  const glm::dvec3& p = point.position;
  const bool even =
      (static_cast<int>(std::floor(p.x / kSquare)) + static_cast<int>(std::floor(p.z / kSquare))) %
          2 ==
      0;
  const double grain = fractal_noise({p.x * 3.0, 0.0, p.z * 24.0}, 3);
  const bool border = glm::length(p) > kTableRadius - 0.16;
  glm::dvec3 albedo = even ? glm::dvec3(0.90, 0.86, 0.76) : glm::dvec3(0.16, 0.40, 0.43);
  if (border) albedo = {0.40, 0.23, 0.12};
  const double open = table_openness(p);
  return {albedo * (0.92 + 0.16 * grain) * (0.25 + 0.75 * open), glm::dvec3(0.07) * open, {}};
}

void add_table(double share, std::vector<ScenePart>& parts) {
  parts.push_back(patch_part(0.9 * share, disc_map(glm::dvec3(0), kTableRadius), table_top));
  const auto rim = [](double v) {
    const double angle = M_PI * (v - 0.5);
    return glm::dvec2(kTableRadius + 0.09 * std::cos(angle), -0.09 + 0.09 * std::sin(angle));
  };
  parts.push_back(patch_part(0.1 * share, lathe_map(glm::dvec3(0), rim), [](const SurfacePoint& p) {
    const double grain = fractal_noise({p.uv.x * 60.0, p.uv.y * 6.0, 0.0}, 3);
    return Material{glm::dvec3(0.42, 0.24, 0.12) * (0.7 + 0.6 * grain), glm::dvec3(0.08), {}};
  }));
}

// Seen from inside: the sphere's map with u reversed. Below the table it grows dark.
void add_room(double share, std::vector<ScenePart>& parts) {
  const SurfaceMap ball = sphere_map(at_height(0, 1.0, 0), kRoomRadius);
  const SurfaceMap inside = [ball](const glm::dvec2& uv) { return ball({1.0 - uv.x, uv.y}); };
  const auto paint = [](const SurfacePoint& p) {
    const double height = (-p.position.y - 1.0) / kRoomRadius;
    const double glow = std::exp(-2.0 * height * height);
    const glm::dvec3 wall =
        glm::mix(glm::dvec3(0.20, 0.22, 0.26), glm::dvec3(0.66, 0.62, 0.56), glow);
    return Material{{}, {}, wall * (0.45 + 0.55 * smooth_step(-0.7, -0.1, height))};
  };
  parts.push_back(patch_part(share, inside, paint, {0.05, 0.9, 0.85, 1.0, kNoEdges}));
}

// 5x7 dots, one row a number, most significant bit on the left.
using Glyph = std::array<int, 7>;
constexpr Glyph kGlyph3 = {14, 17, 1, 6, 1, 17, 14}, kGlyphD = {30, 17, 17, 17, 17, 17, 30},
                kGlyphG = {14, 17, 16, 23, 17, 17, 14}, kGlyphS = {15, 16, 16, 14, 1, 1, 30};

bool in_glyph(const Glyph& glyph, const glm::dvec2& uv) {
  const int column = static_cast<int>(std::floor((uv.x - 0.25) / 0.1));
  const int row = static_cast<int>(std::floor((0.85 - uv.y) / 0.1));
  return column >= 0 && column < 5 && row >= 0 && row < 7 && (glyph[row] >> (4 - column) & 1) != 0;
}

// A block that stands on the height of `base`, turned by `angle`, with a letter on its faces.
void add_block(const glm::dvec3& base, double side, double angle, const glm::dvec3& paint,
               const Glyph& glyph, double share, std::vector<ScenePart>& parts) {
  const double half = 0.5 * side;
  const glm::dvec3 x = half * glm::dvec3(std::cos(angle), 0.0, std::sin(angle));
  const glm::dvec3 z = half * glm::dvec3(-std::sin(angle), 0.0, std::cos(angle));
  const glm::dvec3 down(0.0, half, 0.0), centre = base - down;
  // Every upright face as seen from outside: u to the right, v up.
  const std::array<std::pair<glm::dvec3, glm::dvec3>, 4> sides = {
      std::pair{-z, x}, std::pair{z, -x}, std::pair{x, z}, std::pair{-x, -z}};
  const auto painted = [paint, glyph](const SurfacePoint& p) {
    const glm::dvec2 from_middle = glm::abs(p.uv - 0.5);
    const bool frame = std::max(from_middle.x, from_middle.y) > 0.42;
    const glm::dvec3 wood(0.92, 0.82, 0.62);
    const glm::dvec3 albedo = frame || in_glyph(glyph, p.uv) ? paint : wood;
    const double open = 0.7 + 0.3 * smooth_step(0.0, 0.2, -p.position.y);
    return Material{albedo * open, glm::dvec3(0.04), {}};
  };
  for (const auto& [out, u] : sides) {
    parts.push_back(
        patch_part(share / 5.0, plane_map(centre + out - u + down, 2.0 * u, -2.0 * down), painted));
  }
  parts.push_back(
      patch_part(share / 5.0, plane_map(centre - down - x - z, 2.0 * x, 2.0 * z), painted));
}

void add_marble(double share, std::vector<ScenePart>& parts) {
  PatchLook glass;
  glass.opacity_low = 0.25;
  const ScenePart shell = patch_part(
      0.6 * share, sphere_map(kMarbleCentre, kMarbleRadius),
      [](const SurfacePoint&) {
        return Material{{0.20, 0.42, 0.50}, {0.30, 0.34, 0.36}, {}};
      },
      glass);
  parts.push_back({shell.share, [shell](const PartSample& sample, Random& random) {
                     Surfel surfel = shell.surfel(sample, random);
                     surfel.opacity = random.uniform(0.06, 0.22);  // the inside shows through
                     return surfel;
                   }});
  // Three ribbons twisted about the middle.
  const std::array<glm::dvec3, 3> colours = {
      glm::dvec3(0.95, 0.72, 0.08), glm::dvec3(0.88, 0.20, 0.10), glm::dvec3(0.9, 0.9, 0.88)};
  for (std::size_t i = 0; i < colours.size(); ++i) {
    const double turn = 2.0 * M_PI * static_cast<double>(i) / 3.0;
    const SurfaceMap ribbon = [turn](const glm::dvec2& uv) {
      const double along = 2.0 * uv.x - 1.0, angle = turn + 3.2 * along;
      const double width = 0.78 * kMarbleRadius * std::sqrt(1.0 - along * along) * uv.y;
      return kMarbleCentre + glm::dvec3(0.85 * kMarbleRadius * along, width * std::sin(angle),
                                        width * std::cos(angle));
    };
    parts.push_back(patch_part(0.13 * share, ribbon, [colour = colours[i]](const SurfacePoint&) {
      return Material{{}, {}, colour * 0.85};
    }));
  }
}

std::vector<ScenePart> all_parts() {
  std::vector<ScenePart> parts = toy_rocket_parts(0.38);
  add_table(0.27, parts);
  add_room(0.05, parts);
  parts.push_back(
      patch_part(0.07, sphere_map(kChromeCentre, kChromeRadius), [](const SurfacePoint&) {
        return Material{{0.05, 0.05, 0.06}, {0.80, 0.82, 0.84}, {}};
      }));
  parts.push_back(patch_part(0.055, torus_map(kRingCentre, at_height(0, 1, 0), 0.30, 0.12),
                             [](const SurfacePoint&) {
                               return Material{{0.32, 0.20, 0.04}, {0.72, 0.52, 0.16}, {}};
                             }));
  add_block(at_height(-1.25, 0, -0.55), 0.52, 0.35, {0.10, 0.32, 0.62}, kGlyph3, 0.045, parts);
  add_block(at_height(-1.22, 0.52, -0.52), 0.46, -0.25, {0.75, 0.16, 0.12}, kGlyphD, 0.04, parts);
  add_block(at_height(-1.05, 0, 0.85), 0.50, 0.9, {0.12, 0.48, 0.22}, kGlyphG, 0.04, parts);
  add_block(at_height(1.25, 0, 0.75), 0.50, -0.5, {0.80, 0.50, 0.08}, kGlyphS, 0.04, parts);
  add_marble(0.02, parts);
  return parts;
}

}  // namespace

BuiltinScene make_object_scene(std::uint64_t count) {
  BuiltinScene scene;
  scene.cloud = build_scene(all_parts(), studio_light(), count, 1);
  const glm::dvec3 target = at_height(0, 1.08, 0);
  scene.cameras = {look_at(0, "front", at_height(-1.1, 2.3, -5.6), target, 50),
                   look_at(1, "left", at_height(-5.5, 1.8, 0.4), target, 50),
                   look_at(2, "right", at_height(4.4, 2.9, -3.6), target, 48),
                   look_at(3, "back", at_height(1.6, 3.7, 4.9), at_height(0, 0.9, 0), 50),
                   look_at(4, "close", at_height(0.9, 0.75, -3.2), at_height(0.5, 0.55, -0.6), 55)};
  return scene;
}

BuiltinPath object_turntable() {
  constexpr int kKeys = 36;  // a line between two of them comes nearer by 0.4 %
  constexpr double kRadius = 5.6;
  BuiltinPath path{"turntable", {}, true};
  for (int i = 0; i < kKeys; ++i) {
    const double angle = 2 * M_PI * i / kKeys;
    const glm::dvec3 eye = at_height(-kRadius * std::sin(angle), 2.3, -kRadius * std::cos(angle));
    path.keys.push_back(look_at(i, fmt::format("turntable_{}", i), eye, at_height(0, 1.08, 0), 50));
  }
  return path;
}

}  // namespace sgs
