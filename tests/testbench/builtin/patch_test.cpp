// patch.h and shapes.h: outward normals, areas, and Gaussians of the right size on the surface.
#include "testbench/builtin/patch.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "testbench/builtin/shapes.h"

using namespace sgs;

namespace {

std::vector<Surfel> surfels_of(const ScenePart& part, std::uint64_t count) {
  std::vector<Surfel> surfels;
  for (std::uint64_t i = 0; i < count; ++i) {
    Random random(i);
    surfels.push_back(part.surfel({i, count}, random));
  }
  return surfels;
}

Material grey(const SurfacePoint&) { return {}; }

PatchLook plain() {
  PatchLook look;
  look.edge_contrast = kNoEdges;
  return look;
}

}  // namespace

TEST_CASE("patch: closed shapes show their outside") {
  const glm::dvec3 centre(3, -2, 1);
  const auto outward_everywhere = [&](SurfaceMap map) {
    for (const Surfel& s : surfels_of(patch_part(1, std::move(map), grey, plain()), 300)) {
      REQUIRE(glm::length(s.shading_normal) == Approx(1.0));
      REQUIRE(glm::dot(s.shading_normal, s.position - centre) > 0);
      REQUIRE(glm::determinant(s.axes) == Approx(1.0));
      REQUIRE(glm::dot(s.axes[2], s.shading_normal) == Approx(1.0));
    }
  };
  outward_everywhere(sphere_map(centre, 2.0));
  for (SurfaceMap& map : box_maps(centre, {0.6, 0, 0.8}, {0, 2, 0}, {-2.4, 0, 1.8})) {
    outward_everywhere(std::move(map));
  }
  outward_everywhere(lathe_map(centre, [](double v) { return glm::dvec2(1.0, 2.0 * v - 1.0); }));
  // Of a torus: away from the ring, not from the middle.
  const glm::dvec3 axis = glm::normalize(glm::dvec3(1, 2, 2));
  for (const Surfel& s :
       surfels_of(patch_part(1, torus_map(centre, axis, 2.0, 0.5), grey, plain()), 300)) {
    const glm::dvec3 offset = s.position - centre;
    const glm::dvec3 flat = offset - glm::dot(offset, axis) * axis;
    const glm::dvec3 from_ring = offset - 2.0 * glm::normalize(flat);
    REQUIRE(glm::length(from_ring) == Approx(0.5));
    REQUIRE(glm::dot(s.shading_normal, from_ring) == Approx(0.5));
  }
}

TEST_CASE("patch: discs and planes face the side they promise") {
  for (const Surfel& s : surfels_of(patch_part(1, disc_map({1, 2, 3}, 2.0), grey, plain()), 100)) {
    REQUIRE(s.shading_normal.y == Approx(-1.0));  // up
    REQUIRE(glm::length(s.position - glm::dvec3(1, 2, 3)) <= 2.0);
  }
  const SurfaceMap plane = plane_map({0, 0, 0}, {2, 0, 0}, {0, 3, 0});
  for (const Surfel& s : surfels_of(patch_part(1, plane, grey, plain()), 100)) {
    REQUIRE(s.shading_normal.z == Approx(1.0));
  }
}

TEST_CASE("patch: sizes follow the area of a Gaussian's cell") {
  // 6 square units over 600 Gaussians: a cell is 0.1 x 0.1 by area, stretched 3 to 2 as (u, v) is.
  const SurfaceMap plane = plane_map({0, 0, 0}, {2, 0, 0}, {0, 3, 0});
  PatchLook look = plain();
  look.overlap = 0.7;
  look.flatness = 0.05;
  for (const Surfel& s : surfels_of(patch_part(1, plane, grey, look), 600)) {
    const double size = std::sqrt(s.sigmas.x * s.sigmas.y);
    REQUIRE(size > 0.07 * 0.84);
    REQUIRE(size < 0.07 * 1.21);
    REQUIRE(s.sigmas.x / s.sigmas.y == Approx(1.5));
    REQUIRE(std::abs(s.axes[0].y) == Approx(1.0));  // the longer one along v
    REQUIRE(s.sigmas.z == Approx(0.05 * size));
    REQUIRE(s.opacity >= 0.05);
    REQUIRE(s.opacity <= 0.99);
  }
}

TEST_CASE("patch: Gaussians keep off the edges of a texture") {
  const SurfaceMap plane = plane_map({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const auto two_tone = [](const SurfacePoint& p) {
    Material material;
    material.albedo = glm::dvec3(p.uv.x < 0.5 ? 0.1 : 0.9);
    return material;
  };
  const auto bleeding = [&](double edge_contrast) {
    PatchLook look;
    look.edge_contrast = edge_contrast;
    double beyond = 0;
    for (const Surfel& s : surfels_of(patch_part(1, plane, two_tone, look), 400)) {
      const double side = s.material.albedo.x > 0.5 ? 1.0 : -1.0;
      const double reach =
          std::max(std::abs(s.axes[0].x) * s.sigmas.x, std::abs(s.axes[1].x) * s.sigmas.y);
      beyond += std::max(0.0, reach - side * (s.position.x - 0.5));
    }
    return beyond;
  };
  CHECK(bleeding(0.2) < 0.3 * bleeding(kNoEdges));
  CHECK(bleeding(0.2) > 0.0);
}
