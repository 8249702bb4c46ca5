// Tests of algorithm/splat/spherical_harmonics.h: values by hand, and orthonormality, which fixes
// every constant but its sign.
#include "algorithm/splat/spherical_harmonics.h"

#include <Imath/half.h>

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

using namespace sgs;

namespace {

std::array<double, 16> basis_at(double x, double y, double z) {
  double basis[16];
  sh_basis(3, x, y, z, basis);
  std::array<double, 16> out;
  std::copy(std::begin(basis), std::end(basis), out.begin());
  return out;
}

// Nodes and weights of the 8-point Gauss-Legendre rule on [-1, 1]: exact to degree 15.
void gauss_legendre(std::array<double, 8>& nodes, std::array<double, 8>& weights) {
  for (int i = 0; i < 8; ++i) {
    double t = std::cos(M_PI * (i + 0.75) / 8.5), slope = 0;
    for (int step = 0; step < 50; ++step) {
      double before = 1, now = t;  // Legendre polynomials of degree n - 1 and n
      for (int n = 2; n <= 8; ++n) {
        const double next = ((2 * n - 1) * t * now - (n - 1) * before) / n;
        before = now;
        now = next;
      }
      slope = 8 * (t * now - before) / (t * t - 1);
      t -= now / slope;
    }
    nodes[static_cast<std::size_t>(i)] = t;
    weights[static_cast<std::size_t>(i)] = 2 / ((1 - t * t) * slope * slope);
  }
}

}  // namespace

TEST_CASE("SH basis by hand along the axes") {
  const auto z = basis_at(0, 0, 1);
  const auto check = [](const std::array<double, 16>& basis, std::vector<double> expected) {
    for (std::size_t k = 0; k < 16; ++k) {
      CAPTURE(k);
      CHECK(basis[k] == Approx(expected[k]).margin(1e-15));
    }
  };
  check(z, {0.28209479177387814, 0, 0.4886025119029199, 0, 0, 0, 2 * 0.31539156525252005, 0, 0, 0,
            0, 0, 2 * 0.3731763325901154, 0, 0, 0});
  check(basis_at(1, 0, 0),
        {0.28209479177387814, 0, 0, -0.4886025119029199, 0, 0, -0.31539156525252005, 0,
         0.5462742152960396, 0, 0, 0, 0, 0.4570457994644658, 0, -0.5900435899266435});
  check(basis_at(0, 1, 0),
        {0.28209479177387814, -0.4886025119029199, 0, 0, 0, 0, -0.31539156525252005, 0,
         -0.5462742152960396, 0.5900435899266435, 0, 0.4570457994644658, 0, 0, 0, 0});
}

TEST_CASE("SH basis by hand at (1, 2, 2)/3") {
  // xx = 1/9, yy = zz = 4/9, xy = xz = 2/9, yz = 4/9
  const double expected[16] = {
      0.28209479177387814,           -0.4886025119029199 * 2 / 3,   0.4886025119029199 * 2 / 3,
      -0.4886025119029199 / 3,       1.0925484305920792 * 2 / 9,    -1.0925484305920792 * 4 / 9,
      0.31539156525252005 / 3,       -1.0925484305920792 * 2 / 9,   -0.5462742152960396 / 3,
      0.5900435899266435 * 2 / 27,   2.890611442640554 * 4 / 27,    -0.4570457994644658 * 22 / 27,
      -0.3731763325901154 * 14 / 27, -0.4570457994644658 * 11 / 27, -1.445305721320277 * 2 / 9,
      0.5900435899266435 * 11 / 27};
  const auto basis = basis_at(1.0 / 3, 2.0 / 3, 2.0 / 3);
  for (std::size_t k = 0; k < 16; ++k) {
    CAPTURE(k);
    CHECK(basis[k] == Approx(expected[k]).epsilon(1e-14));
  }
}

TEST_CASE("SH basis is orthonormal over the sphere") {
  std::array<double, 8> nodes{}, weights{};
  gauss_legendre(nodes, weights);
  double gram[16][16] = {};
  constexpr int kTurns = 16;  // exact for products of degree 6
  for (std::size_t i = 0; i < 8; ++i) {
    const double z = nodes[i], ring = std::sqrt(1 - z * z);
    for (int turn = 0; turn < kTurns; ++turn) {
      const double phi = 2 * M_PI * turn / kTurns;
      const auto basis = basis_at(ring * std::cos(phi), ring * std::sin(phi), z);
      for (std::size_t a = 0; a < 16; ++a) {
        for (std::size_t b = 0; b < 16; ++b) {
          gram[a][b] += weights[i] * (2 * M_PI / kTurns) * basis[a] * basis[b];
        }
      }
    }
  }
  for (int a = 0; a < 16; ++a) {
    for (int b = 0; b < 16; ++b) {
      CAPTURE(a, b);
      CHECK(gram[a][b] == Approx(a == b ? 1 : 0).margin(1e-12));
    }
  }
}

TEST_CASE("colour by hand: degree 0 ignores the direction, 0.5 is added, negatives are clamped") {
  const glm::dvec3 dc(1, 0, -3);
  const auto colour = sh_colour<double>(0, &dc, {4, 4, 4});
  CHECK(colour.x == Approx(0.5 + 0.28209479177387814));
  CHECK(colour.y == 0.5);
  CHECK(colour.z == 0);
}

TEST_CASE("colour by hand: degree 1 along -x, in every scalar") {
  const auto check = [](auto zero, double relative) {
    using T = decltype(zero);
    std::vector<glm::vec<3, T>> coeffs(4, glm::vec<3, T>(zero));
    coeffs[3] = {T(0.5F), T(-0.5F), T(2.0F)};  // times -0.4886 x, x = -1
    const auto c = sh_colour<T>(1, coeffs.data(), {T(-4.0F), T(0.0F), T(0.0F)});
    CHECK(static_cast<double>(c.x) == Approx(0.5 + 0.24430125595145995).epsilon(relative));
    CHECK(static_cast<double>(c.y) == Approx(0.5 - 0.24430125595145995).epsilon(relative));
    CHECK(static_cast<double>(c.z) == Approx(0.5 + 0.9772050238058398).epsilon(relative));
  };
  check(0.0, 1e-15);
  check(0.0F, 2e-7);
  check(Imath::half(0.0F), 0.002);  // four roundings of 2^-11
}

TEST_CASE("colour: every coefficient reaches its own channel at degrees 2 and 3") {
  for (const int degree : {2, 3}) {
    const auto count = static_cast<std::size_t>((degree + 1) * (degree + 1));
    const auto basis = basis_at(2.0 / 7, 3.0 / 7, 6.0 / 7);
    for (std::size_t k = 0; k < count; ++k) {
      std::vector<glm::dvec3> coeffs(count, glm::dvec3(0));
      coeffs[k] = {0.1, 0.2, -0.1};
      const auto c = sh_colour<double>(degree, coeffs.data(), {2, 3, 6});
      CAPTURE(degree, k);
      CHECK(c.x == Approx(0.5 + 0.1 * basis[k]));
      CHECK(c.y == Approx(0.5 + 0.2 * basis[k]));
      CHECK(c.z == Approx(0.5 - 0.1 * basis[k]));
    }
  }
}
