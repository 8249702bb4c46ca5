// Lanes and comparators that expressions take, and what waits for what: counted by hand.
#include "modules/datapath/lane_steps.h"

#include <catch2/catch.hpp>
#include <map>
#include <vector>

#include "algorithm/splat/counting.h"
#include "algorithm/splat/spherical_harmonics.h"
#include "tests/modules/datapath/flow_parts.h"

namespace sgs::test {
namespace {

LongestPath path_of(const DataFlow& flow, std::size_t first, std::size_t last,
                    const OperationLatencies& each) {
  return part_of(flow, first, last).longest_path(each);
}
OperationCounts all(const DataFlow& flow) { return flow.counts(0, flow.size()); }

}  // namespace

TEST_CASE("lane macs: a sum is free behind a product that nothing else takes") {
  DataFlow flow;
  const Counting a = input(flow, 2), b = input(flow, 3), c = input(flow, 4);
  const Counting x = input(flow, 5), y = input(flow, 6), z = input(flow, 7);
  CHECK((a * x + b * y + c * z).value == 56);
  CHECK(folded_macs(all(flow)) == 3);
  const Counting product = a * b;
  CHECK((product + c).value == 10);
  CHECK(folded_macs(all(flow)) == 3 + 1);
  CHECK((product - c).value == 2);
  CHECK(folded_macs(all(flow)) == 3 + 3);
}

TEST_CASE("lane macs: quotients share the reciprocal of their divisor") {
  DataFlow flow;
  const Counting a = input(flow, 6), b = input(flow, 9), c = input(flow, 3);
  static_cast<void>(a / c);
  static_cast<void>(b / c);
  CHECK(folded_macs(all(flow)) == kReciprocalMacs + 2 * kQuotientMacs);
  CHECK(seeds(all(flow)) == 1);
}

TEST_CASE("lane macs: functions, comparisons and roundings apart") {
  DataFlow flow;
  const Counting a = input(flow, 2.5F), b = input(flow, 4);
  static_cast<void>(sqrt_of(b));
  static_cast<void>(log_of(b));
  static_cast<void>(exp_of(a));
  CHECK(a < b);
  static_cast<void>(max_of(a, b));
  CHECK(isfinite(a));
  CHECK(truncated_index(a, 10).value == 2);  // above 0? below 10? then toward zero
  static_cast<void>(floor(a));
  CHECK(folded_macs(all(flow)) == kSquareRootMacs + kLogarithmMacs + kExponentialMacs);
  CHECK(comparisons(all(flow)) ==
        5 + 2 * kRoundingComparisons + kLogarithmComparisons + kExponentialComparisons);
}

TEST_CASE("lane macs: whole numbers pass comparators until they are numbers again") {
  DataFlow flow;
  const Counting a = input(flow, 13.5F);
  const CountingIndex moved = truncated_index(a, 100) * 4 / 8 + 3 - 1;
  static_cast<void>(with_bits(moved, 7));
  CHECK(moved < CountingIndex(9));
  CHECK(number_of<Counting>(moved).value == 8.0F);
  CHECK(folded_macs(all(flow)) == 0);
  CHECK(comparisons(all(flow)) == 2 + 1 + kRoundingComparisons + kConversionComparisons + 2);
  // Down, two sums, a number: shifts and masks are wires.
  CHECK(path_of(flow, 0, flow.size(), kLatencies) == LongestPath{0, 3 + 2 + 2, 0});
}

TEST_CASE("lane macs: each degree of spherical harmonics takes more than the one below") {
  std::uint32_t below = 0;
  for (int degree = 0; degree <= 3; ++degree) {
    CAPTURE(degree);
    DataFlow flow;
    Counting basis[16];
    sh_basis(degree, input(flow, 0.1F), input(flow, 0.2F), input(flow, 0.3F), basis);
    const std::uint32_t macs = folded_macs(all(flow));
    CHECK((degree == 0 ? macs == 0 : macs > below));
    below = macs;
  }
}

TEST_CASE("lane steps: as many of a routine as it is counted") {
  DataFlow flow;
  const Counting a = input(flow, 2), b = input(flow, 3);
  static_cast<void>(exp(sqrt(a) / b) + log(b) / Counting(3.0F));
  std::map<StepBy, std::uint32_t> count;
  for (const LaneStep& step : part_of(flow, 0, flow.size()).steps(kLatencies)) ++count[step.by];
  CHECK(count[StepBy::kLane] == folded_macs(all(flow)));
  CHECK(count[StepBy::kComparator] == comparisons(all(flow)));
  CHECK(count[StepBy::kTable] == seeds(all(flow)));
}

TEST_CASE("longest path: what waits for what, by hand") {
  struct Row {
    const char* what;
    Counting (*of)(Counting a, Counting b, Counting c, Counting d);
    LongestPath expected;  // on lanes, on comparators, look-ups
  };
  const Row rows[] = {
      {"one product", [](Counting a, Counting b, Counting, Counting) { return a * b; }, {1, 0, 0}},
      {"a sum right behind its product",
       [](Counting a, Counting b, Counting c, Counting) { return a * b + c; },
       {1, 0, 0}},
      {"two products, one in the sum's lane",
       [](Counting a, Counting b, Counting c, Counting d) { return a * b + c * d; },
       {2, 0, 0}},
      {"the later of two products is the one in the sum's lane",
       [](Counting a, Counting b, Counting c, Counting d) { return a * b + c * d * d; },
       {2, 0, 0}},
      {"the same the other way round",
       [](Counting a, Counting b, Counting c, Counting d) { return c * d * d - a * b; },
       {2, 0, 0}},
      {"a product that two take has left its lane",
       [](Counting a, Counting b, Counting c, Counting) {
         const Counting product = a * b;
         return (product + c) * (product - c);
       },
       {3, 0, 0}},
      {"signs are free, constants are there",
       [](Counting a, Counting, Counting, Counting) { return -abs(a) * Counting(3.0F); },
       {1, 0, 0}},
      {"a quotient from its divisor",
       [](Counting a, Counting b, Counting, Counting) { return a / b; },
       {7, 0, 1}},
      {"a quotient from a late dividend: the reciprocal is made beside it",
       [](Counting a, Counting b, Counting c, Counting d) {
         return (a + b + c + d + a + b + c) / d;
       },
       {6 + 3, 0, 0}},
      {"root, maximum, whole number",
       [](Counting a, Counting b, Counting, Counting) { return ceil(max_of(sqrt(a), b)); },
       {7, 1 + 3, 1}},
      {"logarithm",
       [](Counting a, Counting, Counting, Counting) { return log(a); },
       // exponent apart, row; z / c - 1, r^2, two of the cubic's four, the rest beside
       {4, 1, 1}},
      {"exponential",
       [](Counting a, Counting, Counting, Counting) { return exp(a); },
       // x / ln2, rounded, x - n ln2 in 2, polynomial 7, power of two
       {10, 3 + 1, 0}},
      {"logarithm and power of two",
       [](Counting a, Counting, Counting, Counting) { return exp2_by_table(log(a)); },
       // end of the table, split, row, parabola of two steps, exponent
       {4 + 2, 1 + 1 + 4 + 1, 1 + 1}},
  };
  for (const Row& row : rows) {
    INFO(row.what);
    DataFlow flow;
    const Counting a = input(flow, 2), b = input(flow, 3), c = input(flow, 5), d = input(flow, 7);
    static_cast<void>(row.of(a, b, c, d));
    const LongestPath path = path_of(flow, 0, flow.size(), {3, 1, 1});
    CHECK(path.lane == row.expected.lane);
    CHECK(path.comparator == row.expected.comparator);
    CHECK(path.look_ups == row.expected.look_ups);
  }
}

TEST_CASE("longest path: by cycles, of a range, and from what comes when it is needed") {
  DataFlow flow;
  const Counting a = input(flow, 2), b = input(flow, 3);
  const Counting early = a + b;
  const std::size_t first = flow.size();
  const Counting state = input(flow, 5);
  const Counting weight = early * state, after = state - weight;
  CHECK_FALSE(after < Counting(-100.0F));
  static_cast<void>(floor(floor(floor(b))));  // 9 cycles of comparators, apart from the state
  const std::size_t all = flow.size();
  const LongestPath on_comparators = path_of(flow, 0, all, {1, 1, 1});
  CHECK(on_comparators == LongestPath{0, 9, 0});
  CHECK(on_comparators.cycles({1, 1, 1}) == 9);
  CHECK(path_of(flow, 0, all, {5, 1, 1}) == LongestPath{2, 1, 0});
  CHECK(path_of(flow, 0, first, {4, 1, 1}) == LongestPath{1, 0, 0});
  CHECK(path_of(flow, first, all, {8, 1, 1}) == LongestPath{1, 1, 0});
  CHECK(path_of(flow, 0, early.node + 1, {5, 1, 1}).cycles({5, 1, 1}) == 5);
  // The product in the difference's lane.
  CHECK(path_of(flow, 0, after.node + 1, {5, 1, 1}).cycles({5, 1, 1}) == 10);
  CHECK(flow.nodes()[weight.node].operation == Operation::kMultiply);
  const auto loop = [&](const OperationLatencies& each) {
    return longest_loop(part_of(flow, 0, all, {{state.node}}).steps(each), each);
  };
  CHECK(loop({1, 1, 1}) == LongestPath{1, 1, 0});
  CHECK(loop({3, 1, 1}).cycles({3, 1, 1}) == 4);
  CHECK(longest_loop(part_of(flow, 0, all).steps({1, 1, 1}), {1, 1, 1}) == LongestPath{});
}

}  // namespace sgs::test
