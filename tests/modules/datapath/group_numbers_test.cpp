// Numbers of a group: what is counted, the parts that make them, and when they stand.
#include "modules/datapath/group_numbers.h"

#include <catch2/catch.hpp>
#include <vector>

#include "algorithm/splat/counting.h"
#include "algorithm/splat/group_numbers.h"

namespace sgs::test {
namespace {

constexpr GroupUse kUses[] = {GroupUse::kWalk, GroupUse::kFilter, GroupUse::kPixels,
                              GroupUse::kRays};

TEST_CASE("group numbers: groups row by row, each pixel of the frame in one, counted or not") {
  const PixelSize frame{45, 23}, group{16, 8};
  std::vector<int> seen(static_cast<std::size_t>(frame.width) * frame.height);
  GroupPlaceOf<CountingIndex> counted{0, 0};
  int before = -1;
  for (GroupPlaceOf<int> at; at.y < frame.height; at = group_behind(at, group, frame)) {
    CHECK(at.y * frame.width + at.x > before);
    before = at.y * frame.width + at.x;
    const PixelRect pixels = group_at(at, group, frame);
    const auto again = group_at(counted, group, frame);
    CHECK(pixels.x0 == again.x0.value);
    CHECK(pixels.y0 == again.y0.value);
    CHECK(pixels.x1 == again.x1.value);
    CHECK(pixels.y1 == again.y1.value);
    CHECK(outer_pixels<float>(pixels).right == outer_pixels<Counting>(again).right.value);
    counted = group_behind(counted, group, frame);
    for (int y = pixels.y0; y < pixels.y1; ++y) {
      for (int x = pixels.x0; x < pixels.x1; ++x) ++seen[y * frame.width + x];
    }
  }
  CHECK(seen == std::vector<int>(seen.size(), 1));
}

TEST_CASE("group numbers, counted: what the formulas say") {
  const OperationCounts walk = group_flow(GroupUse::kWalk).counts();
  CHECK(walk.adds == 4);  // a side's distance from the middle
  CHECK(walk.multiplies == 0);
  CHECK(walk.conversions == 4);
  CHECK(walk.index_adds == 4);   // the ends of the group, and their last pixels
  CHECK(walk.comparisons == 3);  // both ends with the frame's, and whether a row begins
  const OperationCounts filter = group_flow(GroupUse::kFilter).counts();
  CHECK(folded_macs(filter) == 0);
  CHECK(filter.conversions == 4);
  CHECK(filter.comparisons == 2);
  // Four parts share columns and rows.
  CHECK(group_flow(GroupUse::kFilter, 2).counts().conversions == 8);
  const OperationCounts rays = group_flow(GroupUse::kRays).counts();
  CHECK(rays.conversions == 0);
  CHECK(rays.index_adds == 2);
  const OperationCounts pixels = group_flow(GroupUse::kPixels).counts();
  CHECK(pixels.index_adds == 2);
  CHECK(pixels.comparisons == 2);
}

TEST_CASE("group numbers: one part of each kind does a group's operations in its interval") {
  const OperationLatencies each = {3, 1, 1};
  for (const GroupUse use : kUses) {
    const FlowPart flow = group_flow(use);
    const GroupNumbers made = group_numbers(flow, each);
    for (const std::uint32_t operations : {folded_macs(made.counts), made.counts.comparisons,
                                           made.counts.index_adds, made.counts.conversions}) {
      CHECK(operations <= made.interval_cycles);
    }
    CHECK(made.depth_cycles >= flow.longest_path(each).cycles(each));
    CHECK(made.register_bits > 0);
  }
}

TEST_CASE("group numbers: they stand their depth behind what they wait for") {
  GroupNumbers made;
  made.interval_cycles = 4;
  made.depth_cycles = 11;
  GroupNumbersInTurn numbers(made);
  CHECK(numbers.stand(0) == 11);
  CHECK(numbers.stand(0) == 15);     // the parts are free
  CHECK(numbers.stand(100) == 111);  // the registers are
  CHECK(numbers.stand(102) == 115);
  CHECK(numbers.groups() == 4);
}

TEST_CASE("group numbers: a third group's wait until the first one's tests have left") {
  GroupNumbers made;
  made.depth_cycles = 5;
  TestedGroupNumbers numbers(made);
  CHECK(numbers.stand(7, 10) == 15);
  numbers.leaves(200);
  CHECK(numbers.stand(7, 20) == 15);
  CHECK(numbers.stand(8, 20) == 25);
  numbers.leaves(300);
  CHECK(numbers.stand(9, 30) == 205);
  numbers.leaves(310);
  CHECK(numbers.stand(12, 400) == 405);
}

}  // namespace
}  // namespace sgs::test
