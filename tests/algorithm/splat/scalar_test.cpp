// Tests of algorithm/splat/scalar.h.
#include "algorithm/splat/scalar.h"

#include <catch2/catch.hpp>
#include <cstdint>
#include <limits>

using namespace sgs;

TEST_CASE("exp_of float: within 1.1 units in the last place of the true value") {
  double worst_ulp = 0;
  const auto check = [&](float x) {
    const double exact = std::exp(static_cast<double>(x));
    const auto nearest = static_cast<float>(exact);
    const double ulp = static_cast<double>(std::nextafter(nearest, INFINITY)) - nearest;
    const double error = std::abs(static_cast<double>(exp_of(x)) - exact) / ulp;
    worst_ulp = std::max(worst_ulp, error);
  };
  // Every 211th float of [-86.6, 88]: the ends of the reduced interval fall between two of them
  // thousands of times. Below -86.6 the units of the result are those of subnormal numbers.
  const auto bits = [](float x) { return __builtin_bit_cast(std::uint32_t, x); };
  for (std::uint32_t i = bits(1e-10F); i < bits(88.0F); i += 211) {
    check(__builtin_bit_cast(float, i));
    if (i < bits(86.6F)) check(-__builtin_bit_cast(float, i));
  }
  CAPTURE(worst_ulp);
  CHECK(worst_ulp <= 1.1);
  CHECK(worst_ulp > 0.5);  // else the measurement itself is wrong
}

TEST_CASE("exp_of float: exact at zero, small and finite at the ends") {
  CHECK(exp_of(0.0F) == 1.0F);
  CHECK(exp_of(-1e30F) > 0.0F);
  CHECK(exp_of(-1e30F) < 2e-38F);
  CHECK(exp_of(-std::numeric_limits<float>::infinity()) == exp_of(-87.0F));
  CHECK(exp_of(1e30F) == exp_of(88.0F));
  CHECK(std::isfinite(exp_of(88.0F)));
}

TEST_CASE("truncated_index: toward zero, clamped, safe outside the range of int") {
  CHECK(truncated_index(0.99F, 10) == 0);
  CHECK(truncated_index(-0.99F, 10) == 0);
  CHECK(truncated_index(-7.0F, 10) == 0);
  CHECK(truncated_index(3.999F, 10) == 3);
  CHECK(truncated_index(10.0F, 10) == 10);
  CHECK(truncated_index(1e30F, 10) == 10);
  CHECK(truncated_index(-1e30F, 10) == 0);
  CHECK(truncated_index(std::numeric_limits<float>::infinity(), 10) == 10);
  CHECK(truncated_index(std::numeric_limits<float>::quiet_NaN(), 10) == 0);
  CHECK(truncated_index(2147483904.0, 2147483647) == 2147483647);
}
