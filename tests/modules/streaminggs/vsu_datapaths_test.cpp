// What a chunk test and a step of a ray execute: counts that can be told from the formulas.
#include "modules/streaminggs/vsu/vsu_datapaths.h"

#include <catch2/catch.hpp>
#include <random>
#include <utility>

#include "algorithm/splat/counting.h"
#include "algorithm/voxel/chunk_test.h"

namespace sgs::test {
namespace {

ChunkBoundOf<Counting> counted(const ChunkBound& bound) {
  ChunkBoundOf<Counting> out;
  for (int k = 0; k < 3; ++k) {
    out.low[k] = Counting(bound.low[k]);
    out.high[k] = Counting(bound.high[k]);
    out.extent[k] = Counting(bound.extent[k]);
  }
  out.scale_max = Counting(bound.scale_max);
  return out;
}

TEST_CASE("chunk test, counted: the counted test computes what the float one computes") {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> place(-3, 3), size(0, 0.5F);
  const ChunkCase tested = longest_chunk_case();
  const auto view = make_view<float>(tested.camera);
  const auto counting_view = make_view<Counting>(tested.camera);
  int touching = 0;
  for (int i = 0; i < 2000; ++i) {
    ChunkBound bound = tested.bound;
    for (int k = 0; k < 3; ++k) {
      bound.low[k] += place(random);
      bound.high[k] = bound.low[k] + size(random);
      bound.extent[k] = size(random);
    }
    bound.scale_max = size(random);
    const ChunkTest test = GroupFrustum(view, tested.group).test(bound);
    const auto again = GroupFrustumOf<Counting>(counting_view, tested.group).test(counted(bound));
    CHECK(test.touches == again.touches);
    CHECK(test.nearest == again.nearest.value);
    CHECK(GroupFrustum(view, tested.group).touches(bound) == test.touches);
    touching += test.touches ? 1 : 0;
  }
  CHECK(touching > 100);
  CHECK(touching < 1900);
}

TEST_CASE(
    "chunk test, counted: the longest case takes all sides, and what the formulas say at least") {
  const ChunkCase tested = longest_chunk_case();
  CHECK(GroupFrustum(make_view<float>(tested.camera), tested.group).test(tested.bound).touches);
  const OperationCounts work = chunk_flow(tested).counts();
  // One quotient for each end of two ranges, one of the spread and two of the reach, by near and
  // far.
  CHECK(work.divisions == 7);
  CHECK(chunk_culling_flow(tested).counts().divisions == 5);  // without the reach
  CHECK(work.divisors <= 2);
  CHECK(work.square_roots == 2);
  // The child out of its node: six bounds of a box, and a row of the table for each extent and the
  // scale, whose exponent is a sum.
  CHECK(work.conversions == 6);
  CHECK(work.look_ups >= 4);
  CHECK(work.scalings == 4);
  CHECK(work.index_adds == 4);
  // Four sides: three products with the middle, three with the half-size, three for n each; three
  // rows of the camera twice.
  CHECK(work.multiplies >= 4 * 9 + 3 * 6);
  ChunkCase behind = tested;
  for (glm::vec3* v : {&behind.bound.low, &behind.bound.high}) {
    *v = glm::vec3(behind.camera.position) - (*v - glm::vec3(behind.camera.position));
  }
  std::swap(behind.bound.low, behind.bound.high);
  CHECK(folded_macs(chunk_flow(behind).counts()) < folded_macs(work) / 2);
}

TEST_CASE("rays, counted: no step takes more than the longest, wherever it begins") {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> place(0.01F, 11.19F), slope(0.01F, 1);
  const OperationCounts longest = ray_step_flow(longest_step_case()).counts();
  const OperationLatencies each = {3, 1, 1};
  const std::uint32_t cycles = ray_step_flow(longest_step_case()).longest_path(each).cycles(each);
  int as_long = 0;
  for (int i = 0; i < 3000; ++i) {
    StepCase step{{place(random), place(random), place(random)}, {}, 0};
    for (int k = 0; k < 3; ++k) {
      step.direction[k] = random() % 2 == 0 ? slope(random) : -slope(random);
    }
    const FlowPart flow = ray_step_flow(step);
    const OperationCounts work = flow.counts();
    CHECK(folded_macs(work) <= folded_macs(longest));
    CHECK(comparisons(work) <= comparisons(longest));
    CHECK(flow.longest_path(each).cycles(each) <= cycles);
    as_long += folded_macs(work) == folded_macs(longest) ? 1 : 0;
  }
  CHECK(as_long > 0);
}

}  // namespace
}  // namespace sgs::test
