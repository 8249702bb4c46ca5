// Counted filters against the filters in float, and the longest case against random ones.
#include "modules/datapath/filter_flows.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstring>
#include <vector>

#include "algorithm/splat/coarse_bound.h"
#include "algorithm/splat/counting.h"
#include "algorithm/splat/extent_bound.h"
#include "algorithm/splat/make_splat.h"
#include "tests/algorithm/splat/random_gaussian.h"
#include "tests/modules/datapath/flow_parts.h"

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

TEST_CASE("filter flows: the counting scalar takes the same decisions and gives the same bits") {
  for_random_cases(3000, [](const FilterCase& tested, RandomGaussians& random) {
    std::vector<glm::vec3> sh(16);
    for (glm::vec3& coefficient : sh) {
      for (int k = 0; k < 3; ++k) coefficient[k] = static_cast<float>(random.normal());
    }
    check_same(tested, sh);
  });
}

TEST_CASE("filter flows: no Gaussian takes more of any operation than the longest case") {
  const OperationCounts coarse = coarse_flow(CoarseBoundBy::kLargestScale, longest_case()).counts();
  const OperationCounts extents = coarse_flow(CoarseBoundBy::kExtents, longest_case()).counts();
  const OperationCounts fine = fine_flow(longest_case(), {3}).all.counts();
  int as_long = 0;
  for_random_cases(3000, [&](const FilterCase& tested, RandomGaussians&) {
    CHECK(none_exceeds(coarse_flow(CoarseBoundBy::kLargestScale, tested).counts(), coarse));
    CHECK(none_exceeds(coarse_flow(CoarseBoundBy::kExtents, tested).counts(), extents));
    const OperationCounts counts = fine_flow(tested, {3}).all.counts();
    CHECK(none_exceeds(counts, fine));
    as_long += folded_macs(counts) == folded_macs(fine) ? 1 : 0;
  });
  CHECK(as_long > 0);
}

TEST_CASE("filter flows: the test against the group waits for the box") {
  for (const std::uint32_t words : {3U, 4U}) {
    CAPTURE(words);
    const FineFlow fine = fine_flow(longest_case(), {0, words});
    const DataFlow& flow = *fine.all.flow;
    const auto path_to = [&](std::size_t last) {
      return FlowPart{fine.all.flow, 0, last, {}}.longest_path(kLatencies).cycles(kLatencies);
    };
    // Every test of the group takes a side of the box, if by way of others.
    std::vector<bool> takes_side(flow.size());
    std::size_t last_side = 0;
    for (std::size_t i = fine.geometry.first; i < fine.group_test.last; ++i) {
      const DataFlow::Node& node = flow.nodes()[i];
      if (i < fine.geometry.last && node.operation == Operation::kTruncate) {
        takes_side[i] = true;
        last_side = i;
      }
      for (const DataFlow::Operand& of : {node.a, node.b}) {
        if (!of.is_constant && takes_side[of.of]) takes_side[i] = true;
      }
      if (i < fine.group_test.first || node.operation < Operation::kCompare) continue;
      CAPTURE(i);
      CHECK(takes_side[i]);
    }
    REQUIRE(last_side > 0);
    // From a side: cut to the frame and to the group, an edge beside the centre, where on it the
    // least lies (a product, and a quotient that begins with one), q there, the least of two, and
    // the verdict.
    const std::uint32_t last = path_to(fine.group_test.last);
    CHECK(last > path_to(last_side + 1) + 2 + 2 + 3 * (1 + 2 + 2) + 2 * (1 + 1) + 2);
    CHECK(last > path_to(fine.geometry.last));
    CHECK(fine.all.longest_path(kLatencies).cycles(kLatencies) == last);
  }
}

TEST_CASE(
    "filter flows: a quaternion of three words takes the fourth's sum and root, ahead of all") {
  for (int degree = 0; degree <= 3; ++degree) {
    const FineFlow stored = fine_flow(longest_case(), {degree, 4});
    const FineFlow decoded = fine_flow(longest_case(), {degree, 3});
    const OperationCounts decode = decoded.decode.counts();
    CHECK(macs(stored.decode) + comparisons(stored.decode.counts()) == 0);
    // The squares are the rotation's, too. Their lanes make the differences, and so no longer the
    // two of the rotation's sums of squares.
    CHECK(folded_macs(decode) == 3 + kSquareRootMacs);
    CHECK(comparisons(decode) == 1 + 1);
    CHECK(seeds(decode) == 1);
    CHECK(macs(decoded.all) == macs(stored.all) + 2 + kSquareRootMacs);
    CHECK(decoded.all.longest_path(kLatencies).cycles(kLatencies) >
          stored.all.longest_path(kLatencies).cycles(kLatencies));
  }
}

TEST_CASE("filter flows: a test that fails early has executed less") {
  FilterCase behind = longest_case();
  behind.gaussian.mean = glm::vec3(behind.camera.position);
  // p - c in two parts, its rotation, and a comparison.
  for (const CoarseBoundBy bound_by : {CoarseBoundBy::kLargestScale, CoarseBoundBy::kExtents}) {
    const OperationCounts coarse = coarse_flow(bound_by, behind).counts();
    CHECK(coarse.comparisons == 1);
    CHECK(coarse.multiplies == 9);
    CHECK(coarse.adds == 12);
    CHECK(coarse.fused == 6);
    CHECK(folded_macs(coarse) == 15);
  }
  const OperationCounts fine = fine_flow(behind, {3}).all.counts();
  CHECK(folded_macs(fine) == 15);
  CHECK(comparisons(fine) == 1);
}

}  // namespace sgs::test
