// The binding resource is the busiest, and the next is the one after it.
#include "testbench/streaminggs/binding.h"

#include <catch2/catch.hpp>

namespace sgs::test {
namespace {

using Catch::Matchers::Contains;

// Of 1,000 cycles.
ActivityResult activity(const char* resource, std::uint64_t busy, std::uint64_t starved) {
  return {"activity", resource, "", busy, starved, 1000 - busy - starved};
}

FrameResult frame_of(const std::vector<ActivityResult>& activities, double bus) {
  FrameResult frame;
  frame.cycles = 1000;
  for (const ActivityResult& a : activities) frame.machine.units.push_back({"unit", {a}, {}});
  frame.memory.bus_utilisation = bus;
  return frame;
}

TEST_CASE("binding: the busiest of all, whatever their order") {
  for (const std::vector<ActivityResult>& activities :
       {std::vector<ActivityResult>{activity("idle", 0, 1000), activity("slow", 900, 50),
                                    activity("middle", 400, 300)},
        {activity("slow", 900, 50), activity("middle", 400, 300), activity("idle", 0, 1000)},
        {activity("middle", 400, 300), activity("idle", 0, 1000), activity("slow", 900, 50)}}) {
    const Binding binding = find_binding(frame_of(activities, 0.1));
    CHECK(binding.unit == "slow");
    CHECK(binding.utilisation == Approx(0.9));
    CHECK(binding.next == "middle");
    CHECK(binding.next_utilisation == Approx(0.4));
    CHECK_THAT(binding.explanation, Contains("slow works 90 % of the frame, middle 40 %") &&
                                        Contains("at least 40 % of its time") &&
                                        !Contains("no resource is busy"));
  }
}

TEST_CASE("binding: the memory's buses are one of the resources") {
  const std::vector<ActivityResult> activities = {activity("unit", 500, 500)};
  CHECK(find_binding(frame_of(activities, 0.51)).unit == "dram");
  CHECK(find_binding(frame_of(activities, 0.51)).next == "unit");
  CHECK(find_binding(frame_of(activities, 0.49)).unit == "unit");
  CHECK(find_binding(frame_of(activities, 0.49)).next == "dram");
  CHECK(find_binding(frame_of({}, 0.49)).next == "nothing else");
}

TEST_CASE("binding: a resource is as busy as its busiest activity") {
  const std::vector<ActivityResult> activities = {
      activity("filters", 100, 0), activity("filters", 700, 300), activity("filters", 300, 0),
      activity("sorting", 600, 0)};
  const std::vector<ResourceUse> uses = resource_uses(frame_of(activities, 0));
  REQUIRE(uses.size() == 3);
  CHECK(uses[0].name == "filters");
  CHECK(uses[0].utilisation == Approx(0.7));
  CHECK(uses[0].waits == "waits for input");
  CHECK(uses[1].name == "sorting");
  CHECK(uses[1].waits == "waits for room downstream");
  CHECK(find_binding(frame_of(activities, 0)).unit == "filters");
}

TEST_CASE("binding: where nothing is busy all the time, it says what the busiest waits for") {
  CHECK_THAT(find_binding(frame_of({activity("a", 790, 200)}, 0)).explanation,
             Contains("no resource is busy all the time: a waits for input"));
  CHECK_THAT(find_binding(frame_of({activity("a", 790, 10)}, 0)).explanation,
             Contains("a waits for room downstream"));
  CHECK_THAT(find_binding(frame_of({activity("a", 810, 10)}, 0)).explanation,
             !Contains("no resource is busy"));
}

}  // namespace
}  // namespace sgs::test
