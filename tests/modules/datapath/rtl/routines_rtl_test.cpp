// Quotients, roots and powers of two that the lanes make of the steps in lane_steps.h, in Verilog,
// beside those of the source: every bit.
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <vector>

#include "Vbeside_lanes.h"
#include "algorithm/splat/exp2.h"
#include "algorithm/splat/half_scalar.h"
#include "modules/datapath/lane_steps.h"
#include "tests/modules/datapath/rtl/lane_rig.h"

namespace sgs::test {
namespace {

using Numbers = std::vector<float>;

// A number for each item, or one for all.
class Operands {
 public:
  Operands(const Numbers& each) : each_(&each) {}  // NOLINT: stands for them
  Operands(float all) : all_(all) {}               // NOLINT
  float operator[](std::size_t i) const { return each_ != nullptr ? (*each_)[i] : all_; }

 private:
  const Numbers* each_ = nullptr;
  float all_ = 0;
};

// Steps of a lane, for all items each.
struct Lanes {
  std::size_t items;
  std::uint32_t steps = 0;

  Numbers step(Operands a, Operands b, Operands c, bool unrounded) {
    std::vector<LaneInput> inputs(items);
    for (std::size_t i = 0; i < items; ++i) inputs[i] = {a[i], b[i], c[i], unrounded};
    const std::vector<LaneOutput> outputs = through_fp32_lane(inputs);
    Numbers sums(items);
    for (std::size_t i = 0; i < items; ++i) sums[i] = outputs[i].sum;
    ++steps;
    return sums;
  }
  Numbers unrounded(Operands a, Operands b, Operands c) { return step(a, b, c, true); }
  Numbers chained(Operands a, Operands b, Operands c) { return step(a, b, c, false); }
  Numbers product(Operands a, Operands b) { return chained(a, b, -0.0F); }
};

Numbers negated(Numbers x) {
  for (float& value : x) value = -value;
  return x;
}

template <class Read>
Numbers looked_up(const Numbers& x, const Read& read) {
  Vbeside_lanes parts;
  Numbers found;
  for (const float value : x) {
    parts.a = bits_of(value);
    parts.eval();
    found.push_back(read(parts));
  }
  return found;
}

Numbers reciprocals(Lanes& lanes, const Numbers& d) {
  Numbers r = looked_up(d, [](const Vbeside_lanes& p) { return float_of(p.reciprocal); });
  for (int i = 0; i < 2; ++i) r = lanes.unrounded(r, lanes.unrounded(negated(d), r, 1.0F), r);
  const Numbers last_bits = looked_up(d, [](const Vbeside_lanes& p) { return p.set_last_bit; });
  for (std::size_t i = 0; i < r.size(); ++i) {
    r[i] = float_of(bits_of(r[i]) | static_cast<std::uint32_t>(last_bits[i]));
  }
  return r;
}

Numbers quotients(Lanes& lanes, const Numbers& n, const Numbers& d, const Numbers& r) {
  const Numbers q = lanes.product(n, r);
  return lanes.unrounded(lanes.unrounded(negated(q), d, n), r, q);
}

Numbers roots(Lanes& lanes, const Numbers& x) {
  Numbers h = looked_up(x, [](const Vbeside_lanes& p) { return float_of(p.half_inverse_root); });
  Numbers twice = h;
  for (float& value : twice) value *= 2;  // one more in the exponent
  Numbers g = lanes.product(x, twice);
  for (int i = 0; i < 2; ++i) {
    const Numbers r = lanes.unrounded(negated(g), h, 0.5F);
    g = lanes.unrounded(g, r, g);
    h = lanes.unrounded(h, r, h);
  }
  return lanes.unrounded(lanes.unrounded(negated(g), g, x), h, g);
}

Numbers powers_of_two(Lanes& lanes, const Numbers& t) {
  const Numbers rest = looked_up(t, [](const Vbeside_lanes& p) { return float_of(p.rest); });
  const Numbers square = looked_up(t, [](const Vbeside_lanes& p) { return float_of(p.square); });
  const Numbers linear = looked_up(t, [](const Vbeside_lanes& p) { return float_of(p.linear); });
  const Numbers constant =
      looked_up(t, [](const Vbeside_lanes& p) { return float_of(p.constant); });
  const Numbers line = lanes.chained(square, rest, linear);
  Numbers sums = lanes.chained(line, rest, constant);
  const Numbers whole =
      looked_up(t, [](const Vbeside_lanes& p) { return static_cast<std::int8_t>(p.exponent); });
  Vbeside_lanes parts;
  parts.operation = 2;  // ADD of comparator.v
  for (std::size_t i = 0; i < sums.size(); ++i) {
    parts.a = bits_of(sums[i]);
    parts.b = static_cast<std::uint32_t>(static_cast<std::int32_t>(whole[i])) << 23;
    parts.eval();
    sums[i] = float_of(parts.value);
  }
  return sums;
}

template <class Expected>
void check_equal(const Numbers& got, const Expected& expected) {
  for (std::size_t i = 0; i < got.size(); ++i) {
    if (bits_of(got[i]) != bits_of(expected(i))) {
      FAIL("item " << i << ": got " << got[i] << ", expected " << expected(i));
    }
  }
}

void check_quotients(const Numbers& n, const Numbers& d) {
  Lanes lanes{n.size()};
  const Numbers r = reciprocals(lanes, d);
  CHECK(lanes.steps == kReciprocalMacs);
  const Numbers q = quotients(lanes, n, d, r);
  CHECK(lanes.steps == kReciprocalMacs + kQuotientMacs);
  check_equal(q, [&](std::size_t i) { return n[i] / d[i]; });
}

// All that rtl/README.md promises. Half of them have a numerator whose quotient lies close to
// halfway between two numbers.
void check_random_quotients(std::size_t count, std::uint64_t seed) {
  RandomNumbers random(seed);
  const auto numerator = [&](float d) {
    if (random.one_in(2)) return random.normal(-102, 127);
    const float quotient = random.normal(-125, 126);
    const double halfway = (static_cast<double>(quotient) + std::nextafter(quotient, 0.0F)) / 2;
    return static_cast<float>(halfway * static_cast<double>(d));
  };
  Numbers n, d;
  while (n.size() < count) {
    const float divisor = random.normal(-126, 125), of = numerator(divisor);
    const float quotient = std::abs(of / divisor);
    if (!(std::abs(of) >= 0x1p-102F && quotient >= 0x1p-125F && quotient < 0x1p127F)) continue;
    n.push_back(of);
    d.push_back(divisor);
  }
  check_quotients(n, d);
}

void check_random_roots(std::size_t count, std::uint64_t seed) {
  RandomNumbers random(seed);
  Numbers x;
  for (std::size_t i = 0; i < count; ++i) {
    const float y = std::abs(random.normal(-50, 63));
    x.push_back(random.one_in(2) ? y : std::abs(random.normal(-102, 127)));
    if (random.one_in(4)) x.back() = y * y;
  }
  Lanes lanes{count};
  const Numbers g = roots(lanes, x);
  CHECK(lanes.steps == kSquareRootMacs);
  check_equal(g, [&](std::size_t i) { return std::sqrt(x[i]); });
}

void check_random_powers(std::size_t count, std::uint64_t seed) {
  RandomNumbers random(seed);
  Numbers t;
  for (std::size_t i = 0; i < count; ++i) {
    t.push_back(random.one_in(3) ? -0.00390625F * static_cast<float>(random.below(32000))
                                 : std::max(-std::abs(random.normal(-30, 6)), kLeastExp2Argument));
  }
  Lanes lanes{count};
  const Numbers powers = powers_of_two(lanes, t);
  CHECK(lanes.steps == 2);
  check_equal(powers, [&](std::size_t i) { return exp2_of(t[i]); });
}

}  // namespace

TEST_CASE("quotients: random ones, near halfway and anywhere") {
  check_random_quotients(kCases, 0);
}
TEST_CASE("quotients: many", "[nightly]") { with_nightly_seeds(check_random_quotients); }

TEST_CASE("quotients: the divisor whose reciprocal the steps miss") {
  constexpr float kOnes = 0x1.fffffep+0F;
  check_quotients({1, 2, 0x1p-40F, -1, 0x1.8p0F, kOnes},
                  {kOnes, kOnes, 2 * kOnes, kOnes, kOnes, kOnes});
}

TEST_CASE("roots: random ones, squares among them") { check_random_roots(kCases, 0); }
TEST_CASE("roots: many", "[nightly]") { with_nightly_seeds(check_random_roots); }

TEST_CASE("powers of two: random ones") { check_random_powers(kCases, 0); }
TEST_CASE("powers of two: many", "[nightly]") { with_nightly_seeds(check_random_powers); }

TEST_CASE("powers of two in half: every argument") {
  std::vector<LaneInput> lines;
  std::vector<int> whole;
  Vbeside_lanes parts;
  for (std::uint16_t bits = 0x8000; half_of(bits) >= kLeastExp2Argument; ++bits) {
    parts.half = bits;
    parts.eval();
    lines.push_back(
        {half_of(parts.linear_half), half_of(parts.rest_half), half_of(parts.constant_half)});
    whole.push_back(static_cast<std::int8_t>(parts.exponent_half));
  }
  const std::vector<LaneOutput> sums = through_fp16_lane(lines);
  for (std::size_t i = 0; i < sums.size(); ++i) {
    parts.half = half_bits_of(sums[i].sum);
    parts.power = static_cast<std::uint8_t>(whole[i]);
    parts.eval();
    const float t = half_of(static_cast<std::uint16_t>(0x8000 + i));
    if (parts.scaled_half != half_bits_of(exp2_of(HalfScalar::exactly(t)).value())) FAIL(t);
  }
  CHECK(sums.size() == 0x57D1);  // halves from -0 to -125
}

}  // namespace sgs::test
