// The formulas with 100 digits, by hand.
#include "testbench/stability/exact.h"

#include <catch2/catch.hpp>

using namespace sgs;

namespace {

bool is_near(const Exact& value, const Exact& expected, const char* relative) {
  return abs(value - expected) <= Exact(relative) * abs(expected);
}

}  // namespace

// 100 x 50 px, focal length 100 px; (1, 0.5, 4): J = [25 0 -6.25; 0 25 -3.125], scales 0.1, 0.2,
// 0.3, a quarter turn about z.
TEST_CASE("exact projection by hand") {
  Camera camera;
  camera.width = 100;
  camera.height = 50;
  camera.focal_x = camera.focal_y = 100;
  const Exact root = sqrt(Exact(2)) / 2;
  const ExactGaussian g{
      {0, 0, 0}, {Exact(1) / 10, Exact(2) / 10, Exact(3) / 10}, {root, 0, 0, root}};
  const ExactSplat s = exact_project(exact_view(camera), g, {1, Exact(1) / 2, 4});
  CHECK(is_near(s.x, Exact("74.5"), "1e-90"));
  CHECK(is_near(s.y, Exact("37"), "1e-90"));
  CHECK(is_near(s.cov_a, Exact("28.815625"), "1e-90"));   // 625*0.04 + 39.0625*0.09 + 0.3
  CHECK(is_near(s.cov_b, Exact("1.7578125"), "1e-90"));   // 6.25*3.125*0.09
  CHECK(is_near(s.cov_c, Exact("7.42890625"), "1e-90"));  // 625*0.01 + 9.765625*0.09 + 0.3
  CHECK(is_near(s.determinant,
                Exact("28.815625") * Exact("7.42890625") - Exact("1.7578125") * Exact("1.7578125"),
                "1e-90"));
  CHECK(is_near(s.conic_a * s.determinant, s.cov_c, "1e-90"));
  CHECK(is_near(s.conic_b * s.determinant, -s.cov_b, "1e-90"));
  // lambda^2 - (a + c) lambda + det = 0.
  CHECK(is_near(s.lambda * s.lambda + s.determinant, (s.cov_a + s.cov_c) * s.lambda, "1e-80"));
}

TEST_CASE("exact camera: v = R^T (p - c), the columns of R are the camera's axes") {
  Camera camera;
  camera.width = camera.height = 10;
  camera.focal_x = camera.focal_y = 10;
  camera.position = {1, 2, 3};
  camera.world_from_camera = glm::dmat3({0, 1, 0}, {0, 0, 1}, {1, 0, 0});
  const ExactVector v = exact_to_camera(exact_view(camera), {11, 22, 33});
  CHECK(v == ExactVector{20, 30, 10});
}

TEST_CASE("exact harmonics: each basis function of degrees 0 to 3 has a mean square of 1 / 4 pi") {
  // Over the 14 directions of a cube's faces and corners with these weights every polynomial of
  // degree 5 has its mean; squares of degree 2 at most are such. Degree 3 by its own axis below.
  for (std::size_t k = 0; k < 9; ++k) {
    std::vector<ExactVector> coeffs(9, ExactVector{0, 0, 0});
    coeffs[k] = {1, 0, 0};
    Exact mean = 0;
    const auto add = [&](const ExactVector& direction, const Exact& weight) {
      const Exact value = exact_colour(2, coeffs, direction)[0] - Exact(1) / 2;
      mean += weight * value * value;
    };
    for (int sign : {-1, 1}) {
      add({sign, 0, 0}, Exact(1) / 15);
      add({0, sign, 0}, Exact(1) / 15);
      add({0, 0, sign}, Exact(1) / 15);
      for (int y : {-1, 1}) {
        for (int z : {-1, 1}) add({sign, y, z}, Exact(3) / 40);
      }
    }
    INFO(k);
    CHECK(is_near(mean, 1 / (16 * atan(Exact(1))), "1e-90"));
  }
}

TEST_CASE("exact harmonics of degree 3 at (0, 0, 1), (1, 1, 1) / sqrt 3 and (1, 0, 0)") {
  const auto value = [](std::size_t k, const ExactVector& direction) {
    std::vector<ExactVector> coeffs(16, ExactVector{0, 0, 0});
    coeffs[k] = {0, 1, 0};
    return static_cast<double>(Exact(exact_colour(3, coeffs, direction)[1] - Exact(1) / 2));
  };
  const double third = 1 / std::sqrt(27.0);
  CHECK(value(12, {0, 0, 2}) == Approx(2 * 0.3731763325901154));
  CHECK(value(10, {1, 1, 1}) == Approx(2.890611442640554 * third));
  CHECK(value(9, {1, 1, 1}) == Approx(-0.5900435899266435 * 2 * third));
  CHECK(value(11, {1, 1, 1}) == Approx(-0.4570457994644658 * 2 * third));
  CHECK(value(13, {3, 0, 0}) == Approx(0.4570457994644658));
  CHECK(value(14, {2, 1, 2}) == Approx(1.445305721320277 * 2 * 3 / 27));
  CHECK(value(15, {3, 0, 0}) == Approx(-0.5900435899266435));
}
