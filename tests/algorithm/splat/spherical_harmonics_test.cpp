// Tests of algorithm/splat/spherical_harmonics.h: values by hand.
#include "algorithm/splat/spherical_harmonics.h"

#include <Imath/half.h>

#include <array>
#include <catch2/catch.hpp>
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

}  // namespace

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
