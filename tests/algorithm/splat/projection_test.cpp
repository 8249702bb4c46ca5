// Tests of algorithm/splat/projection.h and view.h: section 2 of the rendering semantics, by hand.
#include "algorithm/splat/projection.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "algorithm/files/input_error.h"

using namespace sgs;

namespace {

// 100x50 px, focal length 100 px: tan_x = 0.5, tan_y = 0.25, at the origin, along +z.
Camera small_camera() {
  Camera camera;
  camera.width = 100;
  camera.height = 50;
  camera.focal_x = camera.focal_y = 100;
  return camera;
}

Gaussian<double> gaussian_at(double x, double y, double z) {
  return {{x, y, z}, {0.1, 0.2, 0.3}, {1, 0, 0, 0}, 0.5};
}

Projected<double> project_small(const Gaussian<double>& g) {
  const auto view = make_view<double>(small_camera());
  return project(view, g, to_camera(view, g.mean));
}

}  // namespace

TEST_CASE("outside 1.3 times the frustum the Jacobian is clamped, the centre is not") {
  const auto p = project_small(gaussian_at(4, -4, 4));
  CHECK(p.x == Approx(149.5));
  CHECK(p.y == Approx(-75.5));
  // u = 0.65 (1.3 * 0.5), w = -0.325 (1.3 * 0.25): J13 = -25*0.65, J23 = 25*0.325
  CHECK(p.cov_a == Approx(625 * 0.01 + 264.0625 * 0.09 + 0.3).epsilon(1e-13));
  CHECK(p.cov_c == Approx(625 * 0.04 + 66.015625 * 0.09 + 0.3).epsilon(1e-13));
  CHECK(p.cov_b == Approx(-16.25 * 8.125 * 0.09).epsilon(1e-13));
}

TEST_CASE("a round dot: the discriminant of the radius is at least 0.1") {
  auto g = gaussian_at(0, 0, 4);
  g.scale = {0.0, 0.0, 0.0};
  const auto p = project_small(g);
  CHECK(p.determinant == Approx(0.09));
  CHECK(p.conic_a == Approx(1 / 0.3));
  CHECK(p.radius == 3);  // ceil(3 sqrt(0.3 + sqrt(0.1))) = ceil(2.354)
}

TEST_CASE("largest_stretch bounds the singular values of a rotation that is not quite one") {
  CHECK(largest_stretch(glm::dmat3(1.0)) == 1.0);
  CHECK(largest_stretch(glm::dmat3({1.001, 0, 0}, {0, 1, 0}, {0, 0, 0.999})) == Approx(1.001));
  // Columns 0.01 from orthogonal: singular values sqrt(1 +- 0.01).
  const glm::dmat3 skew({1, 0, 0}, {0.01, std::sqrt(1 - 1e-4), 0}, {0, 0, 1});
  CHECK(largest_stretch(skew) == Approx(std::sqrt(1.01)).epsilon(1e-12));
}

TEST_CASE("make_view refuses frames without pixels and frames too large to count") {
  Camera camera = small_camera();
  camera.width = 0;
  CHECK_THROWS_AS(make_view<float>(camera), InputError);
  camera.width = kMaxFramePx + 1;
  CHECK_THROWS_WITH(make_view<float>(camera),
                    "camera 0: size 131073x50 px, expected 1 to 131072 a side");
  camera.width = kMaxFramePx;
  CHECK(make_view<float>(camera).width == kMaxFramePx);
}
