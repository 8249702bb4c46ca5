// Counted filters against the filters in float, and the longest case against random ones.
#include "algorithm/splat/filter_work.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstring>
#include <random>

#include "algorithm/splat/coarse_bound.h"
#include "algorithm/splat/counting.h"
#include "algorithm/splat/counting_half.h"
#include "algorithm/splat/extent_bound.h"
#include "algorithm/splat/lane_macs.h"
#include "algorithm/splat/make_splat.h"
#include "algorithm/splat/rendering_work.h"
#include "tests/algorithm/splat/random_gaussian.h"

namespace sgs::test {
namespace {

bool same_bits(float a, float b) { return std::memcmp(&a, &b, sizeof a) == 0; }

// Nothing is counted of constants, but their arithmetic is the same.
glm::vec<3, Counting> constants(const glm::vec3& v) {
  return {Counting(v.x), Counting(v.y), Counting(v.z)};
}

void check_same(const FilterCase& tested, const std::vector<glm::vec3>& sh) {
  DataFlow flow;
  const auto number = [&](float value) { return input(flow, value); };
  const auto vector = [&](const glm::vec3& v) {
    return glm::vec<3, Counting>(number(v.x), number(v.y), number(v.z));
  };
  const auto view = make_view<float>(tested.camera);
  const auto counting_view = make_view<Counting>(tested.camera);
  const Gaussian<float>& g = tested.gaussian;
  Gaussian<Counting> counting_g{};
  counting_g.mean = vector(g.mean);
  counting_g.scale = vector(g.scale);
  for (std::size_t k = 0; k < 4; ++k) counting_g.quat[k] = number(g.quat[k]);
  counting_g.opacity = number(g.opacity);

  const CoarseBound bound = coarse_bound(view, g.mean, g.scale.x);
  const auto counted = coarse_bound(counting_view, counting_g.mean, counting_g.scale.x);
  REQUIRE(counted.in_front == bound.in_front);
  if (!bound.in_front) return;
  CHECK(same_bits(counted.reach_px.value, bound.reach_px));
  CHECK(same_bits(counted.square_px.value, bound.square_px));
  CHECK(touches(counted, tested.group) == touches(bound, tested.group));

  const ExtentBound extents = extent_bound(view, g.mean, g.scale, g.scale.x);
  const auto counted_extents =
      extent_bound(counting_view, counting_g.mean, counting_g.scale, counting_g.scale.x);
  CHECK(same_bits(counted_extents.reach_squared_x.value, extents.reach_squared_x));
  CHECK(same_bits(counted_extents.reach_squared_y.value, extents.reach_squared_y));
  CHECK(touches(counted_extents, tested.group) == touches(extents, tested.group));

  Splat splat{};
  SplatOf<Counting> counted_splat{};
  REQUIRE(make_geometry(counting_view, counting_g, counted_splat) == make_geometry(view, g, splat));
  if (splat.footprint.empty()) return;
  CHECK(same_bits(counted_splat.x.value, splat.x));
  CHECK(same_bits(counted_splat.conic_a.value, splat.conic_a));
  CHECK(same_bits(counted_splat.conic_b.value, splat.conic_b));
  const auto& box = counted_splat.footprint;
  CHECK(box.x0.value == splat.footprint.x0);
  CHECK(box.y0.value == splat.footprint.y0);
  CHECK(box.x1.value == splat.footprint.x1);
  CHECK(box.y1.value == splat.footprint.y1);
  CHECK(reaches_group(counted_splat, tested.group) == reaches_group(splat, tested.group));

  std::vector<glm::vec<3, Counting>> counted_sh;
  for (const glm::vec3& coefficient : sh) counted_sh.push_back(constants(coefficient));
  add_colour(view, 3, g.mean, sh.data(), splat);
  add_colour(counting_view, 3, counting_g.mean, counted_sh.data(), counted_splat);
  for (int k = 0; k < 3; ++k) CHECK(same_bits(counted_splat.rgb[k].value, splat.rgb[k]));
}

bool none_exceeds(const OperationCounts& a, const OperationCounts& most) {
  return a.multiplies <= most.multiplies && a.adds <= most.adds && a.divisions <= most.divisions &&
         a.divisors <= most.divisors && a.square_roots <= most.square_roots &&
         a.logarithms <= most.logarithms && a.exponentials <= most.exponentials &&
         a.comparisons <= most.comparisons && a.roundings <= most.roundings &&
         a.conversions <= most.conversions && a.index_adds <= most.index_adds &&
         folded_macs(a) <= folded_macs(most) && comparisons(a) <= comparisons(most);
}

// Gaussians of every kind, each against a group of 32 px.
template <class Check>
void for_random_cases(int cases, Check&& check) {
  RandomGaussians random(7, 200, 120);
  for (int i = 0; i < cases; ++i) {
    const Camera camera = random.camera();
    const int x = 32 * random.pick(6), y = 32 * random.pick(3);
    check(FilterCase{camera, random.gaussian(camera), {x, y, x + 32, y + 32}}, random);
  }
}

}  // namespace

TEST_CASE("filter work: the counting scalar takes the same decisions and gives the same bits") {
  for_random_cases(3000, [](const FilterCase& tested, RandomGaussians& random) {
    std::vector<glm::vec3> sh(16);
    for (glm::vec3& coefficient : sh) {
      for (int k = 0; k < 3; ++k) coefficient[k] = static_cast<float>(random.normal());
    }
    check_same(tested, sh);
  });
}

TEST_CASE("filter work: no Gaussian takes more of any operation than the longest case") {
  const OperationCounts coarse = coarse_work(CoarseBoundBy::kLargestScale, longest_case());
  const OperationCounts extents = coarse_work(CoarseBoundBy::kExtents, longest_case());
  const FineWork fine = fine_work(longest_case(), {3});
  int as_long = 0;
  for_random_cases(3000, [&](const FilterCase& tested, RandomGaussians&) {
    CHECK(none_exceeds(coarse_work(CoarseBoundBy::kLargestScale, tested), coarse));
    CHECK(none_exceeds(coarse_work(CoarseBoundBy::kExtents, tested), extents));
    const FineWork work = fine_work(tested, {3});
    CHECK(none_exceeds(work.total(), fine.total()));
    as_long += folded_macs(work.total()) == folded_macs(fine.total()) ? 1 : 0;
  });
  CHECK(as_long > 0);
}

TEST_CASE("filter work: a higher degree costs colour and nothing else") {
  for (int degree = 1; degree <= 3; ++degree) {
    CAPTURE(degree);
    const FineWork lower = fine_work(longest_case(), {degree - 1});
    const FineWork higher = fine_work(longest_case(), {degree});
    CHECK(folded_macs(higher.colour) > folded_macs(lower.colour));
    CHECK(folded_macs(higher.geometry) == folded_macs(lower.geometry));
    CHECK(folded_macs(higher.group_test) == folded_macs(lower.group_test));
    CHECK(folded_macs(higher.total()) == folded_macs(higher.geometry) +
                                             folded_macs(higher.group_test) +
                                             folded_macs(higher.colour));
  }
}

TEST_CASE("filter work: the test against the group waits for the box") {
  constexpr OperationLatencies kEach = {3, 1, 1};
  for (const std::uint32_t words : {3U, 4U}) {
    CAPTURE(words);
    const FineFlow fine = fine_flow(longest_case(), {0, words});
    const std::vector<std::uint32_t> ready = fine.flow.ready_cycles(kEach);
    std::uint32_t first_side = ~0U, last_side = 0;
    for (std::size_t i = fine.decoded; i < fine.geometry_end; ++i) {
      if (fine.flow.nodes()[i].operation != Operation::kTruncate) continue;
      first_side = std::min(first_side, ready[i]);
      last_side = std::max(last_side, ready[i]);
    }
    std::uint32_t last = 0;
    for (std::size_t i = fine.geometry_end; i < fine.test_end; ++i) {
      if (fine.flow.nodes()[i].operation < Operation::kCompare) continue;
      CAPTURE(i);
      CHECK(ready[i] > first_side);
      last = std::max(last, ready[i]);
    }
    // From a side: cut to the frame and to the group, an edge beside the centre, where on it the
    // least lies, q there, the least of two, and the verdict.
    CHECK(last > last_side + 2 + 2 + 3 * (1 + 1 + 1 + 2 + 2) + 2);
    CHECK(fine_path(longest_case(), {0, words}, kEach).cycles(kEach) == last);
  }
}

TEST_CASE(
    "filter work: a quaternion of three words takes the fourth's sum and root, ahead of all") {
  for (int degree = 0; degree <= 3; ++degree) {
    const FineWork whole = fine_work(longest_case(), {degree, 4});
    const FineWork decoded = fine_work(longest_case(), {degree, 3});
    CHECK(folded_macs(whole.decode) + comparisons(whole.decode) == 0);
    // The squares are the rotation's, too: they leave their lanes before the differences.
    CHECK(folded_macs(decoded.decode) == 3 + 3 + kSquareRootMacs);
    CHECK(comparisons(decoded.decode) == 1 + 1);
    CHECK(seeds(decoded.decode) == 1);
    CHECK(folded_macs(decoded.total()) == folded_macs(whole.total()) + 3 + kSquareRootMacs);
    const OperationLatencies each = {3, 1, 1};
    CHECK(fine_path(longest_case(), {degree, 3}, each).cycles(each) >
          fine_path(longest_case(), {degree, 4}, each).cycles(each));
  }
}

TEST_CASE("filter work: a test that fails early has executed less") {
  FilterCase behind = longest_case();
  behind.gaussian.mean = glm::vec3(behind.camera.position);
  // p - c in two parts, its rotation, and a comparison.
  for (const CoarseBoundBy bound_by : {CoarseBoundBy::kLargestScale, CoarseBoundBy::kExtents}) {
    const OperationCounts coarse = coarse_work(bound_by, behind);
    CHECK(coarse.comparisons == 1);
    CHECK(coarse.multiplies == 9);
    CHECK(coarse.adds == 12);
    CHECK(coarse.fused == 6);
    CHECK(folded_macs(coarse) == 15);
  }
  CHECK(folded_macs(fine_work(behind, {3}).total()) == 15);
  CHECK(comparisons(fine_work(behind, {3}).total()) == 1);
}

TEST_CASE("filter work: halves that are counted are the halves of blending") {
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

TEST_CASE("work of rendering a splat, counted") {
  const RenderingWork work = rendering_work(BlendPrecision::kSingle);
  // By hand, a sub-tile: its corner from the centre, 4 columns of dx, A dx^2
  // (2) and B dx, 4 rows of dy and C dy^2 (2). 16 pixels of two sums and a product of the exponent,
  // a parabola, opacity, weight, T behind, and three products and sums of colour; the end of the
  // table, the cap, two selections, the end of T.
  CHECK(work.subtile_blend.multiplies == 4 * 3 + 4 * 2 + 16 * (1 + 2 + 1 + 1 + 3));
  CHECK(work.subtile_blend.adds == 2 + 4 + 4 + 16 * (2 + 2 + 1 + 3));
  CHECK(work.subtile_blend.fused == 16 * (1 + 2 + 3));
  CHECK(folded_macs(work.subtile_blend) == 30 + 16 * 10);
  CHECK(folded_macs(work.conic) == 3);
  // Where the centre is: two sums that a machine may have lanes of their own for.
  CHECK(folded_macs(work.corner) == 2);
  CHECK(folded_macs(work.blend_from_corner) == 28 + 16 * 10);
  CHECK(work.subtile_blend.look_ups == 16);
  CHECK(work.subtile_blend.splits == 16);
  CHECK(work.subtile_blend.scalings == 16);
  CHECK(work.subtile_blend.exponentials == 0);
  CHECK(work.subtile_blend.comparisons == 16 * 5);
  // In half: 4 columns of dx, 4 rows of dy, its part of the length across and the second square
  // (2); a sum and two products for the first square, a line for a parabola. Five numbers scaled by
  // a power of two.
  const RenderingWork in_half = rendering_work(BlendPrecision::kHalf);
  const OperationCounts half = in_half.subtile_blend;
  CHECK(half.multiplies == 4 * 3 + 16 * (2 + 1 + 1 + 1 + 3));
  CHECK(half.adds == 2 + 4 + 4 + 16 * (2 + 1 + 1 + 3));
  CHECK(half.fused == 16 * (1 + 1 + 3));
  CHECK(folded_macs(half) == 22 + 16 * 10);
  CHECK(folded_macs(in_half.blend_from_corner) == 20 + 16 * 10);
  CHECK(half.comparisons == 16 * 5);
  CHECK(half.scalings == 16 + 5);
  // What nothing has rounded before: opacity and colour.
  CHECK(half.roundings == 4);
  // Once a splat, in single precision: the quotient B/A, the rest C - B (B/A), two products with
  // log2(e); A at least 2^-26 of C, and no 0.
  CHECK(in_half.conic.divisions == 1);
  CHECK(in_half.conic.divisors == 1);
  CHECK(folded_macs(in_half.conic) == kReciprocalMacs + kQuotientMacs + 1 + 2);
  CHECK(in_half.conic.comparisons == 2);
  CHECK(in_half.conic.scalings == 1);
  // Of a record that holds halves: only where the centre is gets units; nothing is rounded.
  const OperationCounts of_halves = blend_of_halves_work();
  CHECK(folded_macs(of_halves) == folded_macs(in_half.blend_from_corner));
  CHECK(of_halves.comparisons == 16 * 5);
  CHECK(of_halves.scalings == 16 + 2);
  CHECK(of_halves.roundings == 0);
  // Such a record in single: three products, a sum with one; three products with log2(e).
  const DataFlow terms = terms_of_square_flow();
  CHECK(folded_macs(terms.counts(0, terms.size())) == 4 + 3);
  CHECK(work.subtile_blend.roundings == 0);
  CHECK(work.span.square_roots == 1);
  CHECK(work.spans_begin.square_roots == 2);
}

}  // namespace sgs::test
