// Lanes and comparators that expressions take, and what waits for what: counted by hand.
#include "modules/datapath/lane_steps.h"

#include <catch2/catch.hpp>
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

TEST_CASE("longest path: what waits for what, by hand") {
  struct Row {
    const char* what;
    Counting (*of)(Counting a, Counting b, Counting c, Counting d);
    LongestPath expected;  // sums of lanes, on comparators, look-ups, products of lanes
  };
  const Row rows[] = {
      {"one product",
       [](Counting a, Counting b, Counting, Counting) { return a * b; },
       {0, 0, 0, 1}},
      {"a sum right behind its product",
       [](Counting a, Counting b, Counting c, Counting) { return a * b + c; },
       {1, 0, 0}},
      {"two products, one in the sum's lane",
       [](Counting a, Counting b, Counting c, Counting d) { return a * b + c * d; },
       {1, 0, 0, 1}},
      {"the later of two products is the one in the sum's lane",
       [](Counting a, Counting b, Counting c, Counting d) { return a * b + c * d * d; },
       {1, 0, 0, 1}},
      {"the same the other way round",
       [](Counting a, Counting b, Counting c, Counting d) { return c * d * d - a * b; },
       {1, 0, 0, 1}},
      {"a product leaves its lane ahead of its sum",
       [](Counting a, Counting b, Counting c, Counting d) {
         const Counting product = a * b;
         return max_of(product * d, c - product);
       },
       {0, 1, 0, 2}},
      {"both of one lane",
       [](Counting a, Counting b, Counting, Counting) {
         const Counting product = a * b;
         return product * (b - product);
       },
       {1, 0, 0, 1}},
      {"a product that two sums take: one has a lane of its own",
       [](Counting a, Counting b, Counting c, Counting) {
         const Counting product = a * b;
         return (product + c) * (product - c);
       },
       {1, 0, 0, 2}},
      {"a product that waits for what is added to it",
       [](Counting a, Counting b, Counting c, Counting d) {
         const Counting product = a * b;
         return max_of(product + (c + d), product * d);
       },
       {1, 1, 0, 2}},
      {"signs are free, constants are there",
       [](Counting a, Counting, Counting, Counting) { return -abs(a) * Counting(3.0F); },
       {0, 0, 0, 1}},
      {"a quotient from its divisor",
       [](Counting a, Counting b, Counting, Counting) { return a / b; },
       {6, 0, 1, 1}},
      {"a quotient from a late dividend: the reciprocal is made beside it",
       [](Counting a, Counting b, Counting c, Counting d) {
         return (a + b + c + d + a + b + c) / d;
       },
       {6 + 2, 0, 0, 1}},
      {"root, maximum, whole number",
       [](Counting a, Counting b, Counting, Counting) { return ceil(max_of(sqrt(a), b)); },
       {6, 1 + 3, 1, 1}},
      {"logarithm",
       [](Counting a, Counting, Counting, Counting) { return log(a); },
       // exponent apart, row; z / c - 1, r^2, two of the cubic's four, the rest beside
       {4, 1, 1}},
      {"exponential",
       [](Counting a, Counting, Counting, Counting) { return exp(a); },
       // x / ln2, rounded, x - n ln2 in 2, polynomial 7, power of two
       {9, 3 + 1, 0, 1}},
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
    CHECK(path.products == row.expected.products);
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
