// Comparators, rounding and look-ups in Verilog beside the functions that units call: every bit.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>

#include "Vbeside_lanes.h"
#include "algorithm/splat/exp2.h"
#include "algorithm/splat/extent_bound.h"
#include "algorithm/splat/half_scalar.h"
#include "algorithm/splat/scalar.h"
#include "tests/modules/datapath/rtl/vectors.h"

namespace sgs::test {
namespace {

enum Of : std::uint8_t { kMinimum, kMaximum, kAdd, kLeft, kRight, kZeros };  // comparator.v
enum To : std::uint8_t { kZero, kBelow, kAbove, kNearest };                  // rounding.v

class Parts {
 public:
  std::uint32_t compared(Of operation, std::uint32_t a, std::uint32_t b) {
    module_->operation = operation;
    module_->a = a;
    module_->b = b;
    module_->eval();
    return module_->value;
  }
  float rounded(To to, float x) {
    module_->to = to;
    return float_of(of(x).whole);
  }
  const Vbeside_lanes& of(float x) {
    module_->a = bits_of(x);
    module_->eval();
    return *module_;
  }
  const Vbeside_lanes& of_half(float x, int power = 0) {
    module_->half = half_bits_of(x);
    module_->power = static_cast<std::uint8_t>(power);
    module_->eval();
    return *module_;
  }
  const Vbeside_lanes& of_halves(Of operation, std::uint16_t a, std::uint16_t b) {
    module_->operation = operation;
    module_->half = a;
    module_->other_half = b;
    module_->eval();
    return *module_;
  }
  std::uint32_t chosen(const std::array<std::uint32_t, 4>& words, std::uint32_t which) {
    module_->select = static_cast<std::uint8_t>(which);
    for (const int clock : {0, 1}) {
      module_->clock = static_cast<std::uint8_t>(clock);
      module_->eval();
    }
    module_->select = static_cast<std::uint8_t>(which ^ 3U);  // of the next cycle
    std::copy(words.begin(), words.end(), std::begin(module_->choices.m_storage));
    module_->eval();
    return module_->chosen;
  }
  const Vbeside_lanes& now() const { return *module_; }

 private:
  std::unique_ptr<Vbeside_lanes> module_ = std::make_unique<Vbeside_lanes>();
};

bool compares(Parts& parts, float a, float b) {
  const std::uint32_t least = parts.compared(kMinimum, bits_of(a), bits_of(b));
  const bool less = parts.now().less, less_or_equal = parts.now().less_or_equal;
  const std::uint32_t most = parts.compared(kMaximum, bits_of(a), bits_of(b));
  return less == (a < b) && less_or_equal == (a <= b) && least == bits_of(min_of(a, b)) &&
         most == bits_of(max_of(a, b));
}

bool compares_halves(Parts& parts, std::uint16_t a, std::uint16_t b) {
  const float x = half_of(a), y = half_of(b);
  const std::uint16_t most = parts.of_halves(kMaximum, a, b).value_half;
  const Vbeside_lanes& got = parts.of_halves(kMinimum, a, b);
  return got.less_half == (x < y) && got.less_or_equal_half == (x <= y) &&
         got.value_half == (y < x ? b : a) && most == (x < y ? b : a);
}

bool counts(Parts& parts, std::uint32_t a, std::uint32_t b) {
  const std::uint32_t places = b % 32;
  const auto zeros = a == 0 ? 31U : static_cast<std::uint32_t>(__builtin_clz(a));
  return parts.compared(kAdd, a, b) == a + b && parts.now().less_word == (a < b) &&
         parts.now().equal_word == (a == b) && parts.compared(kLeft, a, places) == a << places &&
         parts.compared(kRight, a, places) == a >> places && parts.compared(kZeros, a, 0) == zeros;
}

bool rounds(Parts& parts, float x) {
  return same_number(parts.rounded(kZero, x), std::trunc(x)) &&
         same_number(parts.rounded(kBelow, x), std::floor(x)) &&
         same_number(parts.rounded(kAbove, x), std::ceil(x)) &&
         same_number(parts.rounded(kNearest, x), std::round(x));
}

// What 2^t begins with, t no more than 0.
bool splits(Parts& parts, float t) {
  const Exp2Parts<float> expected = exp2_parts(t);
  const Vbeside_lanes& got = parts.of(t);
  return bits_of(expected.rest) == got.rest &&
         expected.steps >> kExp2RowBits == static_cast<std::int8_t>(got.exponent) &&
         bits_of(exp2_coefficient(expected, 0)) == got.constant &&
         bits_of(exp2_coefficient(expected, 1)) == got.linear &&
         bits_of(exp2_coefficient(expected, 2)) == got.square;
}
bool splits_half(Parts& parts, HalfScalar t) {
  const Exp2Parts<HalfScalar> expected = exp2_parts(t);
  const Vbeside_lanes& got = parts.of_half(t.value());
  return half_bits_of(expected.rest.value()) == got.rest_half &&
         expected.steps >> kExp2RowBits == static_cast<std::int8_t>(got.exponent_half) &&
         half_bits_of(exp2_coefficient(expected, 0).value()) == got.constant_half &&
         half_bits_of(exp2_coefficient(expected, 1).value()) == got.linear_half;
}

void check_random(std::size_t count, std::uint64_t seed) {
  RandomNumbers random(seed);
  Parts parts;
  for (std::size_t i = 0; i < count; ++i) {
    const float a = random.any(), b = random.one_in(4) ? -random.beside(a) : random.any();
    if (!compares(parts, a, b) || !counts(parts, bits_of(a), bits_of(b))) {
      FAIL("comparator: " << a << ", " << b);
    }
    const float x = random.one_in(2) ? random.any() : std::round(random.normal(-2, 24)) / 2;
    if (!rounds(parts, x)) FAIL("rounding: " << x);
    const float fine = -std::abs(random.normal(-40, 5)),
                coarse = -0.0078125F * static_cast<float>(random.below(16001));
    const float t = random.one_in(2) ? fine : coarse;
    if (!splits(parts, t)) FAIL("split: " << t);
  }
  SUCCEED("all equal");
}

}  // namespace

TEST_CASE("comparator and rounding: special numbers with each other") {
  Parts parts;
  for (const std::uint32_t a : kMagnitudes) {
    for (const std::uint32_t b : kMagnitudes) {
      for (const std::uint32_t signs : {0U, 1U, 2U, 3U}) {
        const float x = float_of(a | signs << 31), y = float_of(b | (signs & 2U) << 30);
        INFO(x << ", " << y);
        CHECK(compares(parts, x, y));
        CHECK(rounds(parts, x));
      }
    }
  }
}

TEST_CASE("comparator of halves: halves of all kinds with each other") {
  Parts parts;
  const auto check = [&](std::uint32_t a, std::uint32_t b) {
    if (!compares_halves(parts, static_cast<std::uint16_t>(a), static_cast<std::uint16_t>(b))) {
      FAIL(half_of(static_cast<std::uint16_t>(a))
           << ", " << half_of(static_cast<std::uint16_t>(b)));
    }
  };
  for (std::uint32_t a = 0; a < 0x10000; a += 0x55) {
    for (std::uint32_t b = 0; b < 0x10000; b += 0x200) check(a, b);
    for (const std::uint32_t beside : {a, a ^ 1, a ^ 0x8000}) check(a, beside);
  }
}

TEST_CASE("comparator, rounding, split: random numbers") { check_random(kCases, 0); }
TEST_CASE("comparator, rounding, split: many numbers", "[nightly]") {
  with_nightly_seeds(check_random);
}

TEST_CASE("split: the ends, and all halves") {
  Parts parts;
  for (const float t : {-0.0F, 0.0F, -0x1p-149F, -0x1p-126F, -0.0078125F, -0.0234375F, -125.0F}) {
    INFO(t);
    CHECK(splits(parts, t));
  }
  for (std::uint16_t bits = 0x8000; half_of(bits) >= -125; ++bits) {
    if (!splits_half(parts, HalfScalar::exactly(half_of(bits)))) FAIL(half_of(bits));
  }
}

TEST_CASE("half scale: every half between 1/2 and 4 by every power") {
  Parts parts;
  for (std::uint16_t bits = 0x3800; bits < 0x4400; ++bits) {
    for (int power = -125; power <= 0; ++power) {
      const HalfScalar x = HalfScalar::exactly(half_of(bits));
      const HalfScalar expected = scaled_by_steps(x, power * kExp2Rows);
      if (half_bits_of(expected.value()) != parts.of_half(x.value(), power).scaled_half) {
        FAIL(x.value() << " 2^" << power);
      }
    }
  }
}

TEST_CASE("choice: each of the words, a cycle after it is selected") {
  Parts parts;
  const std::array<std::uint32_t, 4> words = {0x01234567, 0x89ABCDEF, 0, ~0U};
  for (const std::uint32_t which : {0U, 3U, 1U, 2U, 0U, 1U}) {
    CHECK(parts.chosen(words, which) == words[which]);
  }
}

TEST_CASE("reach table: every row, all exponents of normal numbers") {
  Parts parts;
  for (std::uint32_t row = 0x0080; row < 0x7F80; ++row) {
    const float x = float_of(row << 16);
    if (bits_of(inverse_root_above(x)) != parts.of(x).inverse_root_above) FAIL(x);
  }
}

}  // namespace sgs::test
