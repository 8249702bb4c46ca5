// Tests of algorithm/splat/exp2.h.
#include "algorithm/splat/exp2.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using namespace sgs;

TEST_CASE("exp2_of float: powers of two are exact, tiny below the table, no number stays none") {
  for (int e = 0; e > -125; --e) CHECK(exp2_of(static_cast<float>(e)) == std::ldexp(1.0F, e));
  CHECK(exp2_of(-1e30F) == exp2_of(-125.0F));
  CHECK(exp2_of(-std::numeric_limits<float>::infinity()) == exp2_of(-125.0F));
  CHECK(std::isnan(exp2_of(std::numeric_limits<float>::quiet_NaN())));
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
