// The lanes in Verilog beside float and HalfScalar: every bit.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "algorithm/splat/half_scalar.h"
#include "tests/modules/datapath/rtl/lane_rig.h"

namespace sgs::test {
namespace {

std::string text(const LaneInput& in) {
  char line[120];
  std::snprintf(line, sizeof line, "%a * %a + %a%s", in.a, in.b, in.c,
                in.unrounded ? ", unrounded" : "");
  return line;
}

// All triples of special magnitudes and of signs, with both kinds of product.
std::vector<LaneInput> special_triples() {
  std::vector<LaneInput> inputs;
  const std::size_t numbers = 2 * kMagnitudes.size();
  const auto number = [](std::size_t i) {
    return float_of(kMagnitudes[i / 2] | (i % 2 != 0 ? 0x80000000U : 0U));
  };
  for (std::size_t i = 0; i < 2 * numbers * numbers * numbers; ++i) {
    inputs.push_back({number(i / 2 % numbers), number(i / 2 / numbers % numbers),
                      number(i / 2 / numbers / numbers), i % 2 != 0});
  }
  return inputs;
}

std::vector<LaneInput> random_triples(std::size_t count, std::uint64_t seed) {
  RandomNumbers random(seed);
  std::vector<LaneInput> inputs(count);
  for (LaneInput& in : inputs) {
    in = {random.any(), random.any(), random.any(), random.one_in(2)};
    if (random.one_in(3)) in.c = random.beside(in.a * in.b);
  }
  return inputs;
}

void check_fp32(const std::vector<LaneInput>& inputs) {
  const std::vector<LaneOutput> outputs = through_fp32_lane(inputs);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const LaneInput& in = inputs[i];
    const float product = in.a * in.b;
    const float sum = in.unrounded ? std::fma(in.a, in.b, in.c) : product + in.c;
    const bool same = same_number(outputs[i].product, product) && same_number(outputs[i].sum, sum);
    if (!same) {
      FAIL(text(in) << ": got " << outputs[i].product << ", " << outputs[i].sum << ", expected "
                    << product << ", " << sum);
    }
  }
  CHECK(outputs.size() == inputs.size());
}

void check_fp16(const std::vector<LaneInput>& inputs) {
  const std::vector<LaneOutput> outputs = through_fp16_lane(inputs);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const LaneInput& in = inputs[i];
    const HalfScalar product = HalfScalar::exactly(in.a) * HalfScalar::exactly(in.b);
    const HalfScalar sum = product + HalfScalar::exactly(in.c);
    const bool same = same_number(outputs[i].product, product.value()) &&
                      same_number(outputs[i].sum, sum.value());
    if (!same) {
      FAIL(text(in) << ": got " << outputs[i].product << ", " << outputs[i].sum << ", expected "
                    << product.value() << ", " << sum.value());
    }
  }
  CHECK(outputs.size() == inputs.size());
}

// Special halves and random ones.
std::vector<LaneInput> half_triples(std::size_t count, std::uint64_t seed) {
  constexpr std::array<std::uint16_t, 12> kSpecial = {
      0, 1, 2, 0x3FF, 0x400, 0x401, 0x3BFF, 0x3C00, 0x3C01, 0x7BFF, 0x7C00, 0x7E00};
  RandomNumbers random(seed);
  const auto number = [&] {
    const auto bits = static_cast<std::uint16_t>(random.bits());
    if (random.one_in(2)) return half_of(bits);
    if (random.one_in(3)) {
      return half_of(
          static_cast<std::uint16_t>((bits & 0x8000) | kSpecial[random.below(kSpecial.size())]));
    }
    return half_of(static_cast<std::uint16_t>((bits & 0x83FF) | (8 + random.below(12)) << 10));
  };
  std::vector<LaneInput> inputs(count);
  for (LaneInput& in : inputs) {
    in = {number(), number(), number()};
    const float product = rounded_to_half(in.a * in.b);
    if (random.one_in(3)) {
      in.c = half_of(static_cast<std::uint16_t>(half_bits_of(-product) ^ random.below(8)));
    }
  }
  return inputs;
}

}  // namespace

TEST_CASE("fp32 lane: special numbers with each other") { check_fp32(special_triples()); }
TEST_CASE("fp32 lane: random numbers") { check_fp32(random_triples(kCases, 0)); }
TEST_CASE("fp32 lane: many random numbers", "[nightly]") {
  with_nightly_seeds(
      [](std::size_t cases, std::uint64_t seed) { check_fp32(random_triples(cases, seed)); });
}

TEST_CASE("fp16 lane: random and special halves") { check_fp16(half_triples(kCases, 0)); }
TEST_CASE("fp16 lane: many halves", "[nightly]") {
  with_nightly_seeds(
      [](std::size_t cases, std::uint64_t seed) { check_fp16(half_triples(cases, seed)); });
}

}  // namespace sgs::test
