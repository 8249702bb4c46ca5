// Tests of algorithm/splat/exp2.h.
#include "algorithm/splat/exp2.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "algorithm/splat/half_scalar.h"

using namespace sgs;

TEST_CASE("exp2_of float: within 1.1 units in the last place of the true value") {
  double worst_ulp = 0;
  // Every 211th float of [-125, -1e-10]: hundreds in each 64th.
  const auto bits = [](float x) { return __builtin_bit_cast(std::uint32_t, x); };
  for (std::uint32_t i = bits(1e-10F); i < bits(125.0F); i += 211) {
    const float t = -__builtin_bit_cast(float, i);
    const double exact = std::exp2(static_cast<double>(t));
    const double ulp = std::ldexp(1.0, std::ilogb(exact) - 23);
    worst_ulp = std::max(worst_ulp, std::abs(static_cast<double>(exp2_of(t)) - exact) / ulp);
  }
  CAPTURE(worst_ulp);
  CHECK(worst_ulp <= 1.1);
  CHECK(worst_ulp > 0.5);  // else the measurement itself is wrong
}

TEST_CASE("exp2_of float: powers of two are exact, tiny below the table, no number stays none") {
  for (int e = 0; e > -125; --e) CHECK(exp2_of(static_cast<float>(e)) == std::ldexp(1.0F, e));
  CHECK(exp2_of(-1e30F) == exp2_of(-125.0F));
  CHECK(exp2_of(-std::numeric_limits<float>::infinity()) == exp2_of(-125.0F));
  CHECK(std::isnan(exp2_of(std::numeric_limits<float>::quiet_NaN())));
}

TEST_CASE("exp2_of half: within 1.1 units in the last place, of every half that matters") {
  double worst_ulp = 0;
  for (float t = 0; t >= -13; t -= 0x1p-10F) {
    const float argument = rounded_to_half(t);
    const double exact = std::exp2(static_cast<double>(argument));
    const double ulp = std::ldexp(1.0, std::ilogb(exact) - 10);
    const float result = exp2_of(HalfScalar::exactly(argument)).value();
    CHECK(rounded_to_half(result) == result);
    worst_ulp = std::max(worst_ulp, std::abs(static_cast<double>(result) - exact) / ulp);
  }
  CAPTURE(worst_ulp);
  CHECK(worst_ulp <= 1.1);
  CHECK(worst_ulp > 0.5);
}

TEST_CASE("table of 2^t: a row's parabola meets the next row's within a unit in the last place") {
  for (int row = 0; row + 1 < kExp2Rows; ++row) {
    const auto at = [&](int of, float rest) {
      const auto& c = kExp2Parabolas.column;
      return (c[2][of] * rest + c[1][of]) * rest + c[0][of];
    };
    CHECK(std::abs(at(row, 0x1p-7F) - at(row + 1, -0x1p-7F)) <= 0x1p-22F);
  }
}
