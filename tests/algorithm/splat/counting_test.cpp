// The counting scalar on expressions counted by hand.
#include "algorithm/splat/counting.h"

#include <catch2/catch.hpp>
#include <random>

#include "algorithm/splat/blend.h"
#include "algorithm/splat/spherical_harmonics.h"

namespace sgs {
namespace {

OperationCounts all(const DataFlow& flow) { return flow.counts(0, flow.size()); }

}  // namespace

TEST_CASE("counting: a dot product is three multiplies, two of which the adds follow") {
  DataFlow flow;
  const Counting a = input(flow, 2), b = input(flow, 3), c = input(flow, 4);
  const Counting x = input(flow, 5), y = input(flow, 6), z = input(flow, 7);
  CHECK((a * x + b * y + c * z).value == 56);
  const OperationCounts counts = all(flow);
  CHECK(counts.multiplies == 3);
  CHECK(counts.adds == 2);
  CHECK(counts.fused == 2);
}

TEST_CASE("counting: a product is made in one step with a sum that takes it") {
  DataFlow flow;
  const Counting a = input(flow, 2), b = input(flow, 3), c = input(flow, 4);
  const Counting product = a * b;
  CHECK((product + c).value == 10);
  CHECK(all(flow).fused == 1);
  CHECK((product - c).value == 2);
  CHECK(all(flow).adds == 2);
  CHECK(all(flow).fused == 1);
  // Nothing is added to the product of another range.
  CHECK(flow.counts(product.node + 1, flow.size()).fused == 0);
}

TEST_CASE("counting: a product does not wait for what waits for it") {
  DataFlow flow;
  const Counting a = input(flow, 2), b = input(flow, 3), c = input(flow, 4);
  const Counting product = a * b;
  static_cast<void>(product + max_of(product, c));
  CHECK(all(flow).fused == 0);
  const Counting other = b * c;
  static_cast<void>(product + other);
  CHECK(all(flow).fused == 1);
  static_cast<void>(product - other);  // one of them waits for the other
  CHECK(all(flow).fused == 1);
  static_cast<void>(product + c);
  CHECK(all(flow).fused == 2);
}

TEST_CASE("counting: the same operation again, and operations on constants, cost nothing") {
  DataFlow flow;
  const Counting a = input(flow, 2), b = input(flow, 2);
  CHECK((a * b + b * a).value == 8);
  CHECK(all(flow).multiplies == 1);
  CHECK((a * a).value == 4);  // of equal value, but another operand
  CHECK(all(flow).multiplies == 2);
  CHECK((Counting(3.0F) * Counting(5.0F) * a).value == 30);
  CHECK(all(flow).multiplies == 3);
  CHECK((-abs(a)).value == -2);
  CHECK(all(flow).adds == 1);
}

TEST_CASE("counting: quotients share the reciprocal of their divisor") {
  DataFlow flow;
  const Counting a = input(flow, 6), b = input(flow, 9), c = input(flow, 3);
  CHECK((a / c).value == 2);
  CHECK((b / c).value == 3);
  CHECK(all(flow).divisions == 2);
  CHECK(all(flow).divisors == 1);
  CHECK((a / b).value == 6.0F / 9.0F);
  CHECK(all(flow).divisors == 2);
  CHECK((a / Counting(16.0F)).value == 0.375F);
  CHECK(all(flow).divisions == 3);
  CHECK(all(flow).multiplies == 1);
  CHECK((a / Counting(3.0F)).value == 2);
  CHECK(all(flow).divisions == 4);
  CHECK(all(flow).divisors == 2);
}

TEST_CASE("counting: functions, comparisons and roundings apart") {
  DataFlow flow;
  const Counting a = input(flow, 2.5F), b = input(flow, 4);
  CHECK(sqrt_of(b).value == 2);
  CHECK(log_of(b).value == std::log(4.0F));
  CHECK(exp_of(a).value == exp_of(2.5F));
  CHECK(a < b);
  CHECK_FALSE(a >= b);  // the comparator has said so already
  CHECK(max_of(a, b).value == 4);
  CHECK(isfinite(a));
  CHECK(truncated_index(a, 10).value == 2);  // above 0? below 10? then toward zero
  CHECK(floor(a).value == 2);
  const OperationCounts counts = all(flow);
  CHECK(counts.square_roots == 1);
  CHECK(counts.logarithms == 1);
  CHECK(counts.exponentials == 1);
  CHECK(counts.comparisons == 5);
  CHECK(counts.roundings == 2);
  CHECK(counts.multiplies + counts.adds + counts.divisions == 0);
}

TEST_CASE("counting: whole numbers stay in the graph until they are numbers again") {
  DataFlow flow;
  const Counting a = input(flow, 13.5F);
  const CountingIndex index = truncated_index(a, 100);
  const CountingIndex moved = index * 4 / 8 + 3 - 1;
  CHECK(moved.value == 8);
  CHECK(without_bits(moved, 7).value == 8);
  CHECK(with_bits(moved, 7).value == 15);
  CHECK(max_of(moved, CountingIndex(20)).value == 20);
  CHECK(min_of(moved, CountingIndex(20)).value == 8);
  CHECK(moved < CountingIndex(9));
  CHECK(moved <= CountingIndex(8));
  CHECK(number_of<Counting>(moved).value == 8.0F);
  CHECK(moved_by_units(a, CountingIndex(2)).value == moved_by_units(13.5F, 2));
  const OperationCounts counts = all(flow);
  CHECK(counts.index_adds == 2 + 1);
  CHECK(counts.conversions == 1);
  CHECK(counts.comparisons == 2 + 4);  // the index's ends; the nearest, the farthest, 9, 8
  CHECK(counts.roundings == 1);
}

TEST_CASE("counting: halves that are counted are the halves of blending") {
  std::mt19937 random(5);
  const auto draw = [&](float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(random);
  };
  for (int repeat = 0; repeat < 2000; ++repeat) {
    const float exponent = draw(-20, 0.5F), opacity = draw(0, 1), before = draw(0, 1);
    DataFlow flow;
    const auto counted = [&](float x) { return CountingHalf(input(flow, x)); };
    const HalfScalar t(exponent);
    const HalfScalar alpha = alpha_of(t, exp2_of(t), HalfScalar(opacity));
    const CountingHalf of_t = counted(exponent);
    const CountingHalf of_count = alpha_of(of_t, exp2_of(of_t), counted(opacity));
    CHECK(value_of(of_count) == alpha.value());
    const LightShare<HalfScalar> light = take_light(alpha, HalfScalar(before));
    const LightShare<CountingHalf> same = take_light(of_count, counted(before));
    CHECK(value_of(same.weight) == light.weight.value());
    CHECK(value_of(same.after) == light.after.value());
    CHECK(flow.counts(0, flow.size()).look_ups == 1);
  }
}

}  // namespace sgs
