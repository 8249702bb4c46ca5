// The binding resource is the busiest, and the next is the one after it; where none is busy most of
// the time, the waiting leads to what holds the frame.
#include "testbench/streaminggs/report/binding.h"

#include <catch2/catch.hpp>

namespace sgs::test {
namespace {

using Catch::Matchers::Contains;

// Of 1,000 cycles; the rest is waiting for input.
ActivityResult activity(const char* resource, std::uint64_t busy) {
  const WaitResult rest{WaitFor::kInput, "fifo", "", "entries", 1000 - busy};
  return {"activity", resource, "", busy, {rest}, std::string("more_") + resource};
}

FrameResult frame_of(const std::vector<ActivityResult>& activities, double bus) {
  FrameResult frame;
  frame.cycles = 1000;
  for (const ActivityResult& a : activities) {
    const std::string unit = "unit" + std::to_string(frame.machine.units.size());
    frame.machine.units.push_back({unit, {a}, {}});
  }
  frame.memory.bus_utilisation = bus;
  frame.memory.remedy = "channels";
  return frame;
}

TEST_CASE("binding: the busiest of all, whatever their order") {
  for (const std::vector<ActivityResult>& activities :
       {std::vector<ActivityResult>{activity("idle", 0), activity("slow", 900),
                                    activity("middle", 400)},
        {activity("slow", 900), activity("middle", 400), activity("idle", 0)},
        {activity("middle", 400), activity("idle", 0), activity("slow", 900)}}) {
    const Binding binding = find_binding(frame_of(activities, 0.1));
    CHECK(binding.unit == "slow");
    CHECK(binding.utilisation == Approx(0.9));
    CHECK(binding.next == "middle");
    CHECK(binding.next_utilisation == Approx(0.4));
    CHECK(binding.holds == "slow");
    CHECK(binding.remedy.key == "more_slow");
    CHECK_THAT(binding.sentence(), Contains("slow works 90 % of the frame, middle 40 %") &&
                                       Contains("at least 40 % of its time; raise more_slow") &&
                                       !Contains("no resource works"));
  }
}

TEST_CASE("binding: the memory's buses are one of the resources") {
  const std::vector<ActivityResult> activities = {activity("unit", 500)};
  CHECK(find_binding(frame_of(activities, 0.51)).unit == "dram");
  CHECK(find_binding(frame_of(activities, 0.51)).next == "unit");
  CHECK(find_binding(frame_of(activities, 0.49)).unit == "unit");
  CHECK(find_binding(frame_of(activities, 0.49)).next == "dram");
  CHECK(find_binding(frame_of({}, 0.49)).next == "nothing else");
  CHECK(find_binding(frame_of(activities, 0.9)).remedy.key == "channels");
}

TEST_CASE("binding: more channels are advised with what they cost") {
  Totals area;
  area.memory_interface = {3, 5, 8};
  const auto advice = [&](double bus) {
    return find_binding(frame_of({activity("unit", 800)}, bus), area).advice;
  };
  CHECK(advice(0.9) ==
        "raise channels: twice as many add 5.00 (3.00 .. 8.00) mm2 of PHY and controller");
  CHECK(advice(0.7) == "raise more_unit");
}

TEST_CASE("binding: a resource is as busy as its busiest activity") {
  const std::vector<ActivityResult> activities = {
      activity("filters", 100), activity("filters", 700), activity("filters", 300),
      activity("sorting", 600)};
  const std::vector<ResourceUse> uses = resource_uses(frame_of(activities, 0));
  REQUIRE(uses.size() == 3);
  CHECK(uses[0].name == "filters");
  CHECK(uses[0].utilisation == Approx(0.7));
  CHECK(uses[1].name == "sorting");
  CHECK(find_binding(frame_of(activities, 0)).unit == "filters");
}

TEST_CASE("binding: the waiting is followed from two thirds of the frame downwards") {
  CHECK_THAT(find_binding(frame_of({activity("a", 660)}, 0)).explanation,
             Contains("no resource works more than two thirds of it: "));
  CHECK_THAT(find_binding(frame_of({activity("a", 670)}, 0)).explanation,
             !Contains("no resource works"));
}

TEST_CASE("binding: where the display holds a stream back there is nothing to change") {
  ActivityResult drain = activity("drain", 300);
  drain.waits = {{WaitFor::kRoom, "rendering.host", "", {}, 700}};
  const Binding binding = find_binding(frame_of({drain}, 0.2));
  CHECK(binding.holds == "rendering.host");
  CHECK_FALSE(binding.remedy.known());
  CHECK_THAT(binding.sentence(),
             Contains("70 % of the frame, at rendering.host; there the display holds it back"));
}

TEST_CASE("binding: waits for the display's buffer are named, and decide where they explain most") {
  struct Row {
    std::uint64_t waits;  // of 1,000
    std::uint64_t pictures;
    const char *holds, *told;
  };
  const char* const decides = "the display shows 30 % of the frame, at rendering.host; there the";
  const char* const beside =
      "20 % of its time; unit1.activity waits for a buffer that the display shows 20 % of the "
      "frame; no resource works more than two thirds of it: unit0.activity waits for input 50 % of";
  for (const auto& [waits, pictures, holds, told] :
       {Row{300, 7, "rendering.host", decides}, Row{200, 7, "fifo", beside},
        Row{5, 7, "fifo", "at fifo; raise entries"},
        Row{300, 0, "fifo", "at fifo; raise entries"}}) {
    INFO(waits << " " << pictures);
    ActivityResult drain = activity("drain", 100);
    drain.waits = {{WaitFor::kInput, "rendering.finished", "", {}, 900 - waits},
                   {WaitFor::kRoom, "rendering.host", "", {}, waits}};
    FrameResult frame = frame_of({activity("a", 500), drain}, 0.2);
    frame.stream.pictures = pictures;
    const Binding binding = find_binding(frame);
    CHECK(binding.holds == holds);
    CHECK(binding.remedy.known() == (holds == std::string("fifo")));
    CHECK_THAT(binding.sentence(), Contains(told));
  }
}

// A pipeline of up to three activities: unit.walk -> visits -> filter.test -> splats -> blend.draw.
struct Stage {
  std::uint64_t busy;
  std::vector<WaitResult> waits;
};

FrameResult pipeline_of(const Stage& walk, const Stage& test, const Stage& draw) {
  FrameResult frame;
  frame.cycles = 1000;
  const auto add = [&](const char* unit, const char* name, const Stage& stage) {
    frame.machine.units.push_back(
        {unit, {{name, unit, "", stage.busy, stage.waits, std::string(unit) + ".rate"}}, {}});
  };
  add("unit", "walk", walk);
  add("filter", "test", test);
  add("blend", "draw", draw);
  return frame;
}

TEST_CASE("binding: waiting leads to a unit, a memory or a FIFO") {
  const auto visits_in = [](std::uint64_t n) {
    return WaitResult{WaitFor::kInput, "visits", "unit.walk", "visits.entries", n};
  };
  const auto splats_in = [](std::uint64_t n) {
    return WaitResult{WaitFor::kInput, "splats", "filter.test", "splats.entries", n};
  };
  const auto visits_room = [](std::uint64_t n) {
    return WaitResult{WaitFor::kRoom, "visits", "filter.test", "visits.entries", n};
  };
  const auto splats_room = [](std::uint64_t n) {
    return WaitResult{WaitFor::kRoom, "splats", "blend.draw", "splats.entries", n};
  };
  const auto at_port = [](WaitFor what, const char* key, std::uint64_t n) {
    return WaitResult{what, "unit.memory", "", key, n};
  };
  const auto phase = [](std::uint64_t n) { return WaitResult{WaitFor::kPhase, "", "", "", n}; };
  const auto idle = [](std::uint64_t n) { return WaitResult{WaitFor::kIdle, "", "", "", n}; };
  struct Row {
    const char* what;
    Stage walk, test, draw;
    std::vector<std::string> path;
    std::string holds, key, why;
  };
  const std::vector<Row> rows = {
      {"reads at the far end",
       {200, {at_port(WaitFor::kReads, "in_flight", 800)}},
       {300, {visits_in(700)}},
       {600, {splats_in(400)}},
       {"blend.draw", "filter.test", "unit.walk"},
       "unit.memory",
       "in_flight",
       "waits for answers to its reads 80 % of the frame"},
      {"its port, in the middle",
       {100, {visits_room(900)}},
       {300, {visits_in(100), at_port(WaitFor::kPort, "outstanding", 600)}},
       {500, {splats_in(500)}},
       {"blend.draw", "filter.test"},
       "unit.memory",
       "outstanding",
       "waits for room in its memory port 60 % of the frame"},
      {"one that waits less than half as long as the one it feeds",
       {100, {visits_room(900)}},
       {650, {visits_in(90), idle(260)}},
       {660, {splats_in(190), idle(150)}},
       {"blend.draw", "filter.test"},
       "filter.test",
       "filter.rate",
       "works 65 % of the frame"},
      {"and one that waits half as long",
       {300, {at_port(WaitFor::kReads, "in_flight", 700)}},
       {500, {visits_in(100), idle(400)}},
       {660, {splats_in(190), idle(150)}},
       {"blend.draw", "filter.test", "unit.walk"},
       "unit.memory",
       "in_flight",
       "waits for answers to its reads 70 % of the frame"},
      {"downstream",
       {600, {visits_room(400)}},
       {200, {splats_room(800)}},
       {500, {splats_in(100), idle(400)}},
       {"unit.walk", "filter.test", "blend.draw"},
       "blend.draw",
       "blend.rate",
       "works 50 % of the frame"},
      {"two that wait for each other in turn: the FIFO between them",
       {300, {visits_room(700)}},
       {450, {visits_in(550)}},
       {100, {splats_in(900)}},
       {"filter.test", "unit.walk"},
       "visits",
       "visits.entries",
       "waits for room behind it 70 % of the frame"},
      {"many places of one cause together outweigh one of another",
       {400,
        {at_port(WaitFor::kReads, "in_flight", 210),
         {WaitFor::kReads, "unit.other", "", "other_in_flight", 200},
         visits_room(190)}},
       {100, {visits_in(900)}},
       {100, {splats_in(900)}},
       {"unit.walk"},
       "unit.memory",
       "in_flight",
       "waits for answers to its reads 41 % of the frame"},
      {"two phases: the busiest of the longer, which it fills, though another works more",
       {440, {visits_room(20), phase(540)}},
       {300, {splats_room(160), phase(540)}},
       {400, {splats_in(140), phase(460)}},
       {"blend.draw"},
       "blend.draw",
       "blend.rate",
       "works 40 % of the frame, 74 % of its phase"},
      {"what does not fill its phase: its waiting there, not that for the other",
       {440, {visits_room(20), phase(540)}},
       {300, {splats_room(160), phase(540)}},
       {300, {at_port(WaitFor::kReads, "in_flight", 240), phase(460)}},
       {"blend.draw"},
       "unit.memory",
       "in_flight",
       "waits for answers to its reads 24 % of the frame"},
      {"having had nothing to do is no cause",
       {500, {idle(500)}},
       {100, {visits_in(900)}},
       {100, {splats_in(900)}},
       {"unit.walk"},
       "unit.walk",
       "unit.rate",
       "works 50 % of the frame"},
  };
  for (const Row& row : rows) {
    INFO(row.what);
    const FrameResult frame = pipeline_of(row.walk, row.test, row.draw);
    const Cause cause = follow_waiting(frame);
    CHECK(cause.path == row.path);
    CHECK(cause.holds == row.holds);
    CHECK(cause.remedy.key == row.key);
    CHECK(cause.why == row.why);
    const Binding binding = find_binding(frame);
    CHECK(binding.holds == row.holds);
    CHECK(binding.remedy.key == row.key);
    const std::string last = row.path.size() == 1 ? row.path[0] + " "
                                                  : "the waiting of " + row.path[0] + " leads to " +
                                                        row.path.back() + ", which ";
    CHECK_THAT(binding.sentence(),
               Contains("two thirds of it: " + last + row.why) && Contains("raise " + row.key));
  }
}

TEST_CASE("binding: where the waiting ends without a key, that of the busiest resource is named") {
  struct Row {
    const char *of_wait, *of_activity, *key, *advice;
  };
  for (const auto& [of_wait, of_activity, key, advice] :
       {Row{"entries", "lanes", "entries", "raise entries"},
        Row{"", "lanes", "lanes",
            "no key of the configuration is known to change that; to shorten what a works, raise "
            "lanes"},
        Row{"", "", "", "no key of the configuration is known to change that"}}) {
    FrameResult frame = frame_of({activity("a", 500)}, 0);
    ActivityResult& only = frame.machine.units[0].activities[0];
    only.waits[0].remedy = of_wait;
    only.remedy = of_activity;
    const Binding binding = find_binding(frame);
    CHECK(binding.holds == "fifo");
    CHECK(binding.remedy.key == key);
    CHECK(binding.advice == advice);
    const Binding empty = without_advice(binding);
    CHECK(!empty.remedy.known());
    CHECK_THAT(empty.sentence(), Contains(binding.explanation) && !Contains("raise"));
  }
}

}  // namespace
}  // namespace sgs::test
