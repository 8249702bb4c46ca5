// Harmonics with 100 digits, by hand.
#include "testbench/stability/exact.h"

#include <catch2/catch.hpp>

using namespace sgs;

namespace {

bool is_near(const Exact& value, const Exact& expected, const char* relative) {
  return abs(value - expected) <= Exact(relative) * abs(expected);
}

}  // namespace

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
