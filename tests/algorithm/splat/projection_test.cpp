// Tests of algorithm/splat/projection.h and view.h: section 2 of the rendering semantics, by hand.
#include "algorithm/splat/projection.h"

#include <Imath/half.h>

#include <catch2/catch.hpp>
#include <limits>

#include "algorithm/files/input_error.h"
#include "tests/algorithm/splat/random_gaussian.h"

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

template <class T>
Gaussian<T> gaussian_at(double x, double y, double z) {
  Gaussian<T> g{};
  g.mean = {T(static_cast<float>(x)), T(static_cast<float>(y)), T(static_cast<float>(z))};
  g.scale = {constant<T>(0.1), constant<T>(0.2), constant<T>(0.3)};
  g.quat = {T(1.0F), T(0.0F), T(0.0F), T(0.0F)};
  g.opacity = T(0.5F);
  return g;
}

template <class T>
Projected<T> project_small(const Gaussian<T>& g) {
  const auto view = make_view<T>(small_camera());
  return project(view, g, to_camera(view, g.mean));
}

template <class T>
double number(T value) {
  return static_cast<double>(value);
}

// (1, 0.5, 4): v_x/v_z = 1/4, v_y/v_z = 1/8; J = [25 0 -6.25; 0 25 -3.125],
// Sigma = diag(0.01, 0.04, 0.09).
template <class T>
void check_inside(double relative) {
  const auto p = project_small(gaussian_at<T>(1, 0.5, 4));
  const auto close = [&](double value) { return Approx(value).epsilon(relative); };
  CHECK(number(p.x) == close(74.5));  // ((0.25/0.5 + 1) 100 - 1)/2
  CHECK(number(p.y) == close(37.0));  // ((0.125/0.25 + 1) 50 - 1)/2
  CHECK(number(p.depth) == 4.0);
  CHECK(number(p.cov_a) == close(10.065625));    // 625*0.01 + 39.0625*0.09 + 0.3
  CHECK(number(p.cov_b) == close(1.7578125));    // 6.25*3.125*0.09
  CHECK(number(p.cov_c) == close(26.17890625));  // 625*0.04 + 9.765625*0.09 + 0.3
  CHECK(number(p.determinant) == close(260.4171484375));
  CHECK(number(p.conic_a) == close(26.17890625 / 260.4171484375));
  CHECK(number(p.conic_b) == close(-1.7578125 / 260.4171484375));
  CHECK(number(p.conic_c) == close(10.065625 / 260.4171484375));
  CHECK(number(p.radius) == 16);  // ceil(3 sqrt(26.368438)) = ceil(15.405)
}

}  // namespace

TEST_CASE("projection by hand: double") { check_inside<double>(1e-14); }

TEST_CASE("projection by hand: float") { check_inside<float>(1e-6); }

TEST_CASE("projection by hand: half") {
  // A half has 11 bits: roundoff 2^-11. The longest chain, the determinant, makes about 15
  // roundings in a row, of which inputs and products add up at worst: 2^-11 * 15 = 0.7 %.
  check_inside<Imath::half>(0.007);
}

TEST_CASE("outside 1.3 times the frustum the Jacobian is clamped, the centre is not") {
  const auto p = project_small(gaussian_at<double>(4, -4, 4));
  CHECK(p.x == Approx(149.5));
  CHECK(p.y == Approx(-75.5));
  // u = 0.65 (1.3 * 0.5), w = -0.325 (1.3 * 0.25): J13 = -25*0.65, J23 = 25*0.325
  CHECK(p.cov_a == Approx(625 * 0.01 + 264.0625 * 0.09 + 0.3).epsilon(1e-13));
  CHECK(p.cov_c == Approx(625 * 0.04 + 66.015625 * 0.09 + 0.3).epsilon(1e-13));
  CHECK(p.cov_b == Approx(-16.25 * 8.125 * 0.09).epsilon(1e-13));
}

TEST_CASE("a quarter turn about z exchanges the x and y scales") {
  auto g = gaussian_at<double>(0, 0, 4);
  g.quat = {std::sqrt(0.5), 0, 0, std::sqrt(0.5)};
  const auto p = project_small(g);
  CHECK(p.cov_a == Approx(625 * 0.04 + 0.3).epsilon(1e-13));
  CHECK(p.cov_c == Approx(625 * 0.01 + 0.3).epsilon(1e-13));
  CHECK(p.cov_b == Approx(0).margin(1e-12));
}

TEST_CASE("rotation matrix of a quaternion: 120 degrees about (1,1,1) permutes the axes") {
  double rows[3][3];
  rotation_rows<double>({0.5, 0.5, 0.5, 0.5}, rows);
  const double expected[3][3] = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}};  // x to y, y to z, z to x
  for (int row = 0; row < 3; ++row) {
    for (int col = 0; col < 3; ++col) CHECK(rows[row][col] == expected[row][col]);
  }
}

TEST_CASE("a round dot: the discriminant of the radius is at least 0.1") {
  auto g = gaussian_at<double>(0, 0, 4);
  g.scale = {0.0, 0.0, 0.0};
  const auto p = project_small(g);
  CHECK(p.determinant == Approx(0.09));
  CHECK(p.conic_a == Approx(1 / 0.3));
  CHECK(p.radius == 3);  // ceil(3 sqrt(0.3 + sqrt(0.1))) = ceil(2.354)
}

TEST_CASE("needles of ratio 10^10: the float determinant keeps five digits") {
  // a c - b^2 in float has none left: its terms agree in their first 12 digits and more.
  test::RandomGaussians random(5, 640, 360);
  int needles = 0;
  for (int i = 0; i < 2000; ++i) {
    const Camera camera = random.camera();
    Gaussian<float> g = random.gaussian(camera);
    const float longest = static_cast<float>(random.log_uniform(0.1, 1e3));
    g.scale = {longest, longest * 1e-10F, longest * 1e-10F};
    const auto view = make_view<float>(camera);
    const auto v = to_camera(view, g.mean);
    if (!(v.z > 0.2F)) continue;
    ++needles;
    // Two minors vanish and |u1 x u2| is at most s1 s2 |J|^2, far below the low-pass terms.
    const auto p = project(view, g, v);
    const double exact = 0.09 + 0.3 * (static_cast<double>(p.cov_a) + p.cov_c - 0.6);
    REQUIRE(static_cast<double>(p.determinant) == Approx(exact).epsilon(1e-5));
  }
  CHECK(needles > 1000);
}

TEST_CASE("view transform: v = R^T (p - c), columns of the rotation are the camera's axes") {
  Camera camera = small_camera();
  camera.position = {1, 2, 3};
  camera.world_from_camera = glm::dmat3({0, 1, 0}, {0, 0, 1}, {1, 0, 0});
  const auto v = to_camera(make_view<float>(camera), glm::vec3(11, 22, 33));
  CHECK(v.x == 20);
  CHECK(v.y == 30);
  CHECK(v.z == 10);
}

TEST_CASE("coordinates of 10^6: the camera centre keeps what float drops of it") {
  Camera camera = small_camera();
  camera.position = {1e6 + 0.0123, -2e6 + 0.0456, 3e6 - 0.0789};
  const auto v = to_camera(make_view<float>(camera), glm::vec3(1e6F, -2e6F, 3e6F + 4));
  CHECK(v.x == Approx(-0.0123).epsilon(1e-6));
  CHECK(v.y == Approx(-0.0456).epsilon(1e-6));
  CHECK(v.z == Approx(4.0789).epsilon(1e-6));
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
